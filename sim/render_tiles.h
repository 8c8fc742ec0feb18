#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <compare>
#include <map>
#include <vector>

#include "sim/world.h"

namespace plumbline {

/// Where the world's standing geoms lie in plan, in squares: what a picture may need is found without asking all.
class TileIndex {
 public:
  static constexpr double kTile_m = 64.0;

  struct Key {
    int x = 0;
    int y = 0;
    auto operator<=>(const Key&) const = default;
  };

  explicit TileIndex(const World& world);

  /// The squares that hold something within a distance of a place, in order of their keys.
  std::vector<Key> near(const Eigen::Vector3d& place, double distance_m) const;
  /// Geoms that may lie in a square, in their order.
  std::vector<int> geoms_in(const Key& key) const;
  /// A square with the heights that what lies in it may take.
  Eigen::AlignedBox3d box_of(const Key& key) const;

 private:
  std::map<Key, std::vector<int>> geoms_;
  std::vector<int> boundless_;  ///< infinite planes
  double lowest_m_ = 0.0;
  double highest_m_ = 0.0;
};

}  // namespace plumbline
