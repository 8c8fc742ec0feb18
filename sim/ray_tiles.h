#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <vector>

#include "sim/ray_surfaces.h"
#include "sim/tile_key.h"

namespace plumbline {

/// Where surfaces lie in plan, in squares, so that the near ones are found without asking all.
class RayTiles {
 public:
  explicit RayTiles(const SurfaceLists& lists);

  /// Surfaces within a distance, in plan, of any place of a square.
  SurfaceSelection near(const SurfaceLists& lists, const TileKey& square, double distance_m) const;
  /// Whether near() of a square would be all there is.
  bool all_within(const TileKey& square, double distance_m) const;
  /// Of all surfaces; empty if there are none.
  const Eigen::AlignedBox2d& plan() const { return plan_; }

 private:
  std::map<TileKey, SurfaceSelection> tiles_;
  Eigen::AlignedBox2d plan_;
};

}  // namespace plumbline
