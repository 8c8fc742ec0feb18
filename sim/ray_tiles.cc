#include "sim/ray_tiles.h"

#include <algorithm>

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
    for_each_tile(plan, [&](const TileKey& key) { tiles_[key].triangles.push_back(i); });
  }
  for (std::uint32_t i = 0; i < lists.bounded.size(); ++i) {
    const Eigen::AlignedBox2d plan = plan_of(lists.bounded[i]);
    plan_.extend(plan);
    for_each_tile(plan, [&](const TileKey& key) { tiles_[key].bounded.push_back(i); });
  }
}

bool RayTiles::all_within(const TileKey& square, double distance_m) const {
  const Eigen::AlignedBox2d from = square.plan();
  const Eigen::Array2d beyond = (from.min() - plan_.min()).array().max((plan_.max() - from.max()).array());
  return plan_.isEmpty() || beyond.max(0.0).matrix().norm() <= distance_m;
}

SurfaceSelection RayTiles::near(const SurfaceLists& lists, const TileKey& square, double distance_m) const {
  const Eigen::AlignedBox2d from = square.plan();
  const Eigen::Array2d margin = Eigen::Array2d::Constant(distance_m);
  SurfaceSelection near;
  const auto reached = [&](const Eigen::AlignedBox2d& plan) { return from.exteriorDistance(plan) <= distance_m; };
  for_each_tile({Eigen::Vector2d(from.min().array() - margin), Eigen::Vector2d(from.max().array() + margin)},
                [&](const TileKey& key) {
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
