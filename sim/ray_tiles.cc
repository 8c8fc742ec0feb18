#include "sim/ray_tiles.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

Eigen::AlignedBox2d plan_of(const TriangleSoup& soup, std::uint32_t triangle) {
  Eigen::AlignedBox2d plan;
  for (const std::uint32_t corner : soup.triangles()[triangle]) {
    plan.extend(Eigen::Vector2d(soup.vertices()[corner].head<2>()));
  }
  return plan;
}

Eigen::AlignedBox2d plan_of(const AnalyticSurface& surface) {
  const Eigen::AlignedBox3d bounds = bounds_in_world(surface);
  return {Eigen::Vector2d(bounds.min().head<2>()), Eigen::Vector2d(bounds.max().head<2>())};
}

int tile_at(double coordinate) { return static_cast<int>(std::floor(coordinate / RayTiles::kTile_m)); }

template <typename Visit>
void for_each_tile(const Eigen::AlignedBox2d& plan, Visit visit) {
  for (int x = tile_at(plan.min().x()); x <= tile_at(plan.max().x()); ++x) {
    for (int y = tile_at(plan.min().y()); y <= tile_at(plan.max().y()); ++y) visit(RayTiles::Key{x, y});
  }
}

void sort_unique(std::vector<std::uint32_t>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

RayTiles::RayTiles(const SurfaceLists& lists) {
  const auto triangle_count = static_cast<std::uint32_t>(lists.triangles.triangles().size());
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const Eigen::AlignedBox2d plan = plan_of(lists.triangles, i);
    plan_.extend(plan);
    for_each_tile(plan, [&](const Key& key) { tiles_[key].triangles.push_back(i); });
  }
  for (std::uint32_t i = 0; i < lists.bounded.size(); ++i) {
    const Eigen::AlignedBox2d plan = plan_of(lists.bounded[i]);
    plan_.extend(plan);
    for_each_tile(plan, [&](const Key& key) { tiles_[key].bounded.push_back(i); });
  }
}

RayTiles::Key RayTiles::key_at(const Eigen::Vector3d& place) { return {tile_at(place.x()), tile_at(place.y())}; }

bool RayTiles::all_within(const Key& square, double distance_m) const {
  const Eigen::Array2d low(square.x * kTile_m, square.y * kTile_m);
  const Eigen::Array2d beyond = (low - plan_.min().array()).max(plan_.max().array() - low - kTile_m);
  return plan_.isEmpty() || beyond.max(0.0).matrix().norm() <= distance_m;
}

SurfaceSelection RayTiles::near(const SurfaceLists& lists, const Key& square, double distance_m) const {
  const Eigen::Vector2d low(square.x * kTile_m, square.y * kTile_m);
  const Eigen::AlignedBox2d from(low, Eigen::Vector2d(low.array() + kTile_m));
  const Eigen::Array2d margin = Eigen::Array2d::Constant(distance_m);
  SurfaceSelection near;
  const auto reached = [&](const Eigen::AlignedBox2d& plan) { return from.exteriorDistance(plan) <= distance_m; };
  for_each_tile({Eigen::Vector2d(from.min().array() - margin), Eigen::Vector2d(from.max().array() + margin)},
                [&](const Key& key) {
                  const auto found = tiles_.find(key);
                  if (found == tiles_.end()) return;
                  for (const std::uint32_t i : found->second.triangles) {
                    if (reached(plan_of(lists.triangles, i))) near.triangles.push_back(i);
                  }
                  for (const std::uint32_t i : found->second.bounded) {
                    if (reached(plan_of(lists.bounded[i]))) near.bounded.push_back(i);
                  }
                });
  sort_unique(near.triangles);
  sort_unique(near.bounded);
  return near;
}

}  // namespace plumbline
