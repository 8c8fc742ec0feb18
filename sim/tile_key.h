#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <compare>

namespace plumbline {

/// Squares of the world's plan, by which what is near is found without asking all.
struct TileKey {
  static constexpr double kTile_m = 64.0;

  int x = 0;
  int y = 0;
  auto operator<=>(const TileKey&) const = default;

  static TileKey at(const Eigen::Vector2d& place) {
    return {static_cast<int>(std::floor(place.x() / kTile_m)), static_cast<int>(std::floor(place.y() / kTile_m))};
  }
  Eigen::AlignedBox2d plan() const {
    const Eigen::Vector2d low(x * kTile_m, y * kTile_m);
    return {low, Eigen::Vector2d(low.array() + kTile_m)};
  }
};

/// Visits the squares that a rectangle touches, by rows of increasing x.
template <typename Visit>
void for_each_tile(const Eigen::AlignedBox2d& plan, Visit visit) {
  const TileKey low = TileKey::at(plan.min());
  const TileKey high = TileKey::at(plan.max());
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) visit(TileKey{x, y});
  }
}

}  // namespace plumbline
