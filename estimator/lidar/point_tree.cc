#include "estimator/lidar/point_tree.h"

#include <nanoflann.hpp>
#include <utility>

namespace plumbline {

void NearestSamples::offer(double squared_distance, const MapSample& sample) {
  if (squared_distance >= worst()) return;
  if (!normal_.isZero() && normal_.dot(sample.normal) < 0.5F) return;
  int i = full() ? size_ - 1 : size_++;
  for (; i > 0 && distances_[static_cast<std::size_t>(i) - 1] > squared_distance; --i) {
    distances_[static_cast<std::size_t>(i)] = distances_[static_cast<std::size_t>(i) - 1];
    samples_[static_cast<std::size_t>(i)] = samples_[static_cast<std::size_t>(i) - 1];
  }
  distances_[static_cast<std::size_t>(i)] = squared_distance;
  samples_[static_cast<std::size_t>(i)] = &sample;
}

namespace {

/// The points as nanoflann reads them.
struct SampleAccess {
  std::vector<MapSample> samples;

  std::size_t kdtree_get_point_count() const { return samples.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return samples[i].position[static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// NearestSamples as nanoflann fills it.
struct ResultAccess {
  using DistanceType = double;
  const SampleAccess& access;
  NearestSamples& nearest;

  bool addPoint(double squared_distance, std::uint32_t index) {
    nearest.offer(squared_distance, access.samples[index]);
    return true;
  }
  double worstDist() const { return nearest.worst(); }
  bool full() const { return nearest.full(); }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, SampleAccess>, SampleAccess, 3,
                                                 std::uint32_t>;

}  // namespace

struct PointTree::Impl {
  SampleAccess access;
  std::unique_ptr<Tree> tree;
};

PointTree::PointTree() : impl_(std::make_unique<Impl>()) {}
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;
PointTree::~PointTree() = default;

void PointTree::build(std::vector<MapSample> samples) {
  impl_->tree.reset();
  impl_->access.samples = std::move(samples);
  if (impl_->access.samples.empty()) return;
  impl_->tree = std::make_unique<Tree>(3, impl_->access, nanoflann::KDTreeSingleIndexAdaptorParams(10));
}

void PointTree::search(const Eigen::Vector3d& query, NearestSamples& nearest) const {
  if (!impl_->tree) return;
  ResultAccess result{impl_->access, nearest};
  impl_->tree->findNeighbors(result, query.data(), nanoflann::SearchParams());
}

}  // namespace plumbline
