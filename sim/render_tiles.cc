#include "sim/render_tiles.h"

#include <mujoco/mujoco.h>

#include <algorithm>

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

Eigen::AlignedBox2d plan_of_box(const Eigen::AlignedBox3d& box) {
  return {Eigen::Vector2d(box.min().head<2>()), Eigen::Vector2d(box.max().head<2>())};
}

bool is_boundless(const mjModel& model, int geom) {
  return model.geom_type[geom] == mjGEOM_PLANE &&
         (model.geom_size[3 * geom] <= 0.0 || model.geom_size[3 * geom + 1] <= 0.0);
}

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
    for_each_tile(plan_of_box(bounds), [&](const TileKey& key) { geoms_[key].push_back(geom); });
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

std::vector<TileKey> TileIndex::near(const Eigen::Vector3d& place, double distance_m) const {
  const Eigen::Array3d reach = Eigen::Array3d::Constant(distance_m);
  std::vector<TileKey> keys;
  for_each_tile(plan_of_box({place.array() - reach, place.array() + reach}), [&](const TileKey& key) {
    if (boundless_.empty() && !geoms_.contains(key)) return;
    if (box_of(key).exteriorDistance(place) <= distance_m) keys.push_back(key);
  });
  return keys;
}

std::vector<int> TileIndex::geoms_in(const TileKey& key) const {
  std::vector<int> geoms = boundless_;
  const auto found = geoms_.find(key);
  if (found != geoms_.end()) geoms.insert(geoms.end(), found->second.begin(), found->second.end());
  std::sort(geoms.begin(), geoms.end());
  return geoms;
}

Eigen::AlignedBox3d TileIndex::box_of(const TileKey& key) const {
  const Eigen::AlignedBox2d plan = key.plan();
  return {Eigen::Vector3d(plan.min().x(), plan.min().y(), lowest_m_),
          Eigen::Vector3d(plan.max().x(), plan.max().y(), highest_m_)};
}

}  // namespace plumbline
