#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <vector>

#include "sim/tile_key.h"
#include "sim/world.h"

namespace plumbline {

/// Where the world's standing geoms lie in plan, in squares: what a picture may need is found without asking all.
class TileIndex {
 public:
  explicit TileIndex(const World& world);

  /// The squares that hold something within a distance of a place, in order of their keys.
  std::vector<TileKey> near(const Eigen::Vector3d& place, double distance_m) const;
  /// Geoms that may lie in a square, in their order.
  std::vector<int> geoms_in(const TileKey& key) const;
  /// A square with the heights that what lies in it may take.
  Eigen::AlignedBox3d box_of(const TileKey& key) const;

 private:
  std::map<TileKey, std::vector<int>> geoms_;
  std::vector<int> boundless_;  ///< infinite planes
  double lowest_m_ = 0.0;
  double highest_m_ = 0.0;
};

}  // namespace plumbline
