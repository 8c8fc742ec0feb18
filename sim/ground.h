#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {

/// The surface that wheels roll on: heights of the world's own surfaces, found by rays that look down from a little
/// above the route, and bumps finer than the scene's. Kept on a grid as far as they were asked for, so that a wheel's
/// step costs no rays. Where nothing is found the route itself is the ground. Things that move are not driven on.
class Ground {
 public:
  static constexpr double kAbove_m = 1.0;  ///< the rays start so far above the route: kerbs are ground, bridges are not
  static constexpr double kBelow_m = 3.0;

  /// `world` and `rays` must outlive it.
  /// @param cell_m       of the grid, between whose nodes heights are bilinear
  /// @param roughness_m  standard deviation of the bumps, of waves 3.2 m down to 0.2 m long, their spectrum falling
  ///                     with the square of the wave number (as ISO 8608 describes roads)
  Ground(const World& world, const RayScene& rays, double cell_m, double roughness_m, std::uint64_t seed);

  /// @param route_z  height of the route near by
  double height(double x, double y, double route_z);

 private:
  static constexpr int kTile = 64;  // nodes along a tile's edge
  using TileKey = std::tuple<long, long, long>;
  using Tile = std::vector<float>;

  double node(long ix, long iy, double route_z);
  Tile& tile_at(const TileKey& key);
  double measured(double x, double y, double route_z);
  double bumps(double x, double y) const;

  const World& world_;
  const RayScene& rays_;
  double cell_m_;
  double roughness_m_;
  std::uint64_t seed_;
  std::map<TileKey, Tile> tiles_;
  TileKey last_key_;
  Tile* last_tile_ = nullptr;
  std::optional<RayWindow> window_;
  Eigen::Vector3d window_place_ = Eigen::Vector3d::Zero();
};

}  // namespace plumbline
