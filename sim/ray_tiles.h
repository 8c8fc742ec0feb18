#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <compare>
#include <cstdint>
#include <map>
#include <vector>

#include "sim/ray_surfaces.h"

namespace plumbline {

/// Where surfaces lie in plan, in squares, so that the near ones are found without asking all.
class RayTiles {
 public:
  static constexpr double kTile_m = 64.0;

  struct Key {
    int x = 0;
    int y = 0;
    auto operator<=>(const Key&) const = default;
  };

  explicit RayTiles(const SurfaceLists& lists);

  static Key key_at(const Eigen::Vector3d& place);
  /// Surfaces within a distance, in plan, of any place of a square.
  SurfaceSelection near(const SurfaceLists& lists, const Key& square, double distance_m) const;
  /// Whether near() of a square would be all there is.
  bool all_within(const Key& square, double distance_m) const;
  /// Of all surfaces; empty if there are none.
  const Eigen::AlignedBox2d& plan() const { return plan_; }

 private:
  std::map<Key, SurfaceSelection> tiles_;
  Eigen::AlignedBox2d plan_;
};

}  // namespace plumbline
