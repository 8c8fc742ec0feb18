#include "sim/render_tiles.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "sim/geom_mesh.h"
#include "sim/render_chunks.h"

namespace plumbline {
namespace {

constexpr double kCoarse_m = 1.0;  // curved surfaces as coarse as that still span their bounds within it

Eigen::AlignedBox3d bounds_of(const World& world, int geom) {
  const TriangleMesh mesh = mesh_of_geom(world.model(), geom, kCoarse_m, 0.0);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(world.data().geom_xmat + 9 * geom);
  const Eigen::Map<const Eigen::Vector3d> position(world.data().geom_xpos + 3 * geom);
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    bounds.extend(Eigen::Vector3d(rotation * vertex.cast<double>() + position));
  }
  const bool curved = world.model().geom_type[geom] != mjGEOM_MESH && world.model().geom_type[geom] != mjGEOM_BOX;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(curved ? kCoarse_m : 1e-6);
  return {bounds.min() - margin, bounds.max() + margin};
}

bool is_boundless(const mjModel& model, int geom) {
  return model.geom_type[geom] == mjGEOM_PLANE &&
         (model.geom_size[3 * geom] <= 0.0 || model.geom_size[3 * geom + 1] <= 0.0);
}

int tile_at(double coordinate) { return static_cast<int>(std::floor(coordinate / TileIndex::kTile_m)); }

}  // namespace

TileIndex::TileIndex(const World& world) {
  Eigen::AlignedBox3d all;
  for (int geom = 0; geom < world.model().ngeom; ++geom) {
    if (!is_drawn(world, geom) || world.mover_of(geom) >= 0) continue;
    if (is_boundless(world.model(), geom)) {
      boundless_.push_back(geom);
      continue;
    }
    const Eigen::AlignedBox3d bounds = bounds_of(world, geom);
    all.extend(bounds);
    for (int x = tile_at(bounds.min().x()); x <= tile_at(bounds.max().x()); ++x) {
      for (int y = tile_at(bounds.min().y()); y <= tile_at(bounds.max().y()); ++y) geoms_[{x, y}].push_back(geom);
    }
  }
  if (!all.isEmpty()) {
    lowest_m_ = all.min().z();
    highest_m_ = all.max().z();
  }
  // A boundless plane may slope: it counts as everywhere.
  if (!boundless_.empty()) {
    lowest_m_ = -1e6;
    highest_m_ = 1e6;
  }
}

std::vector<TileIndex::Key> TileIndex::near(const Eigen::Vector3d& place, double distance_m) const {
  std::vector<Key> keys;
  for (int x = tile_at(place.x() - distance_m); x <= tile_at(place.x() + distance_m); ++x) {
    for (int y = tile_at(place.y() - distance_m); y <= tile_at(place.y() + distance_m); ++y) {
      const Key key{x, y};
      if (boundless_.empty() && !geoms_.contains(key)) continue;
      if (box_of(key).exteriorDistance(place) <= distance_m) keys.push_back(key);
    }
  }
  return keys;
}

std::vector<int> TileIndex::geoms_in(const Key& key) const {
  std::vector<int> geoms = boundless_;
  const auto found = geoms_.find(key);
  if (found != geoms_.end()) geoms.insert(geoms.end(), found->second.begin(), found->second.end());
  std::sort(geoms.begin(), geoms.end());
  return geoms;
}

Eigen::AlignedBox3d TileIndex::box_of(const Key& key) const {
  return {Eigen::Vector3d(key.x * kTile_m, key.y * kTile_m, lowest_m_),
          Eigen::Vector3d((key.x + 1) * kTile_m, (key.y + 1) * kTile_m, highest_m_)};
}

}  // namespace plumbline
