#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace plumbline {

/// A map point as a search finds it.
struct MapSample {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m], in W
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< planes: unit, towards where it was seen from; edges: zero
};

/// The nearest map points to a query, nearest first, gathered over several trees.
class NearestSamples {
 public:
  static constexpr int kCapacity = 16;

  /// @param wanted  at most kCapacity
  /// @param normal  samples facing more than 60 degrees away from it are other surfaces and not taken; zero takes all
  NearestSamples(int wanted, double largest_distance, const Eigen::Vector3f& normal)
      : wanted_(std::min(wanted, kCapacity)), farthest_(largest_distance * largest_distance), normal_(normal) {}

  int size() const { return size_; }
  const MapSample& operator[](int i) const { return *samples_[static_cast<std::size_t>(i)]; }
  void offer(double squared_distance, const MapSample& sample);
  /// Squared distance beyond which no sample is wanted any more.
  double worst() const { return full() ? distances_[static_cast<std::size_t>(size_) - 1] : farthest_; }
  bool full() const { return size_ == wanted_; }

 private:
  std::array<const MapSample*, kCapacity> samples_{};
  std::array<double, kCapacity> distances_{};
  int size_ = 0;
  int wanted_;
  double farthest_;  // squared
  Eigen::Vector3f normal_;
};

/// A KD-tree over its own copy of some map points.
class PointTree {
 public:
  PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;
  ~PointTree();

  void build(std::vector<MapSample> samples);
  void search(const Eigen::Vector3d& query, NearestSamples& nearest) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
