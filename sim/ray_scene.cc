#include "sim/ray_scene.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <mutex>
#include <utility>
#include <vector>

#include "sim/geom_mesh.h"
#include "sim/mover_path.h"
#include "sim/ray_surfaces.h"
#include "sim/ray_tiles.h"

namespace plumbline {
namespace {

// A world no wider than this is one window: all of it, whatever is asked.
constexpr double kWholeWorld_m = 400.0;
// Windows reach in steps of this, so that sensors of different ranges share them.
constexpr double kReachStep_m = 50.0;
constexpr std::size_t kWindowsKept = 8;

using WindowKey = std::pair<TileKey, int>;  // the square, and how many steps it reaches
constexpr WindowKey kEverything{{0, 0}, -1};

// As mj_ray: a material's alpha, where there is one, stands instead of the geom's own.
bool is_transparent(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float alpha = material >= 0 ? model.mat_rgba[4 * material + 3] : model.geom_rgba[4 * geom + 3];
  return alpha == 0.0F;
}

bool is_analytic(int geom_type) {
  return geom_type == mjGEOM_PLANE || geom_type == mjGEOM_SPHERE || geom_type == mjGEOM_CAPSULE ||
         geom_type == mjGEOM_ELLIPSOID || geom_type == mjGEOM_CYLINDER;
}

AnalyticSurface::Kind kind_of(int geom_type) {
  switch (geom_type) {
    case mjGEOM_PLANE:
      return AnalyticSurface::Kind::kPlane;
    case mjGEOM_CAPSULE:
      return AnalyticSurface::Kind::kCapsule;
    case mjGEOM_ELLIPSOID:
      return AnalyticSurface::Kind::kEllipsoid;
    case mjGEOM_CYLINDER:
      return AnalyticSurface::Kind::kCylinder;
    default:
      return AnalyticSurface::Kind::kSphere;
  }
}

struct MovingThing {
  MoverPath path;
  SurfaceLists lists;  ///< in the mover's frame
  std::unique_ptr<RaySurfaces> surfaces;
  double radius_m = 0.0;  ///< about its origin
};

double radius_of(const SurfaceLists& lists) {
  double radius = 0.0;
  for (const Eigen::Vector3d& vertex : lists.triangles.vertices()) radius = std::max(radius, vertex.norm());
  for (const AnalyticSurface& surface : lists.bounded) {
    const Eigen::AlignedBox3d box = bounds_in_world(surface);
    radius = std::max(radius, box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm());
  }
  return radius;
}

bool ray_meets_ball(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const Eigen::Vector3d& centre,
                    double radius, double max_range_m) {
  const Eigen::Vector3d to_centre = centre - origin;
  const double along = std::clamp(to_centre.dot(direction), 0.0, max_range_m);
  return (to_centre - along * direction).squaredNorm() <= radius * radius;
}

// The normal looks towards the ray's side.
void finish(const Eigen::Vector3d& direction, RayHit& hit) {
  if (!hit.hit) {
    hit = {};
  } else if (hit.normal_in_world.dot(direction.cast<float>()) > 0.0F) {
    hit.normal_in_world = -hit.normal_in_world;
  }
}

}  // namespace

struct RayScene::Impl {
  explicit Impl(const World& world);

  void add_geom(const World& world, int geom);
  std::shared_ptr<const RaySurfaces> standing_near(const Eigen::Vector3d& place, double reach_m);

  EmbreeDevice device;
  SurfaceLists standing;
  std::vector<AnalyticSurface> infinite_planes;
  std::vector<MovingThing> movers;  ///< as world.movers()
  std::unique_ptr<RayTiles> tiles;
  std::shared_ptr<const RaySurfaces> whole;  ///< of a small world
  std::mutex mutex;
  std::list<std::pair<WindowKey, std::shared_ptr<const RaySurfaces>>> kept;  ///< the one used last in front
};

struct RayWindow::NearMover {
  std::size_t mover = 0;
  Eigen::Vector3d centre;  ///< at the window's time
  double reach_m = 0.0;    ///< of its surfaces about there, within the window's slack
};

RayScene::Impl::Impl(const World& world) {
  for (const Mover& mover : world.movers()) movers.push_back({MoverPath(mover), {}, nullptr, 0.0});
  for (int geom = 0; geom < world.model().ngeom; ++geom) {
    if (world.model().geom_bodyid[geom] != world.rig_body() && !is_transparent(world.model(), geom)) {
      add_geom(world, geom);
    }
  }
  for (MovingThing& thing : movers) {
    thing.surfaces = std::make_unique<RaySurfaces>(device, thing.lists, all_of(thing.lists));
    thing.radius_m = radius_of(thing.lists);
  }
  tiles = std::make_unique<RayTiles>(standing);
  const bool small = tiles->plan().isEmpty() || tiles->plan().sizes().maxCoeff() <= kWholeWorld_m;
  if (small) whole = std::make_shared<const RaySurfaces>(device, standing, all_of(standing));
}

void RayScene::Impl::add_geom(const World& world, int geom) {
  constexpr double kUnused = 1.0;  // tolerance and extent, of types that do not come here
  const mjModel& model = world.model();
  Eigen::Vector3d position = Eigen::Map<const Eigen::Vector3d>(world.data().geom_xpos + 3L * geom);
  Eigen::Matrix3d rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(world.data().geom_xmat + 9L * geom);
  SurfaceLists* lists = &standing;
  if (const int mover = world.mover_of(geom); mover >= 0) {
    lists = &movers[static_cast<std::size_t>(mover)].lists;
    const Pose mover_from_world = world.initial_pose_of_mover(static_cast<std::size_t>(mover)).inverse();
    position = mover_from_world * position;
    rotation = mover_from_world.rotation.toRotationMatrix() * rotation;
  }
  if (!is_analytic(model.geom_type[geom])) {
    lists->triangles.append(mesh_of_geom(model, geom, kUnused, kUnused), rotation, position, geom);
    return;
  }
  const AnalyticSurface surface{kind_of(model.geom_type[geom]),
                                Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3L * geom), rotation, position,
                                geom};
  (is_bounded(surface) ? lists->bounded : infinite_planes).push_back(surface);
}

std::shared_ptr<const RaySurfaces> RayScene::Impl::standing_near(const Eigen::Vector3d& place, double reach_m) {
  if (whole) return whole;
  const int steps = static_cast<int>(std::ceil(std::min(reach_m, 1e6) / kReachStep_m));
  WindowKey key{TileKey::at(place.head<2>()), steps};
  if (tiles->all_within(key.first, steps * kReachStep_m)) key = kEverything;
  const std::lock_guard lock(mutex);
  const auto found = std::find_if(kept.begin(), kept.end(), [&](const auto& entry) { return entry.first == key; });
  if (found != kept.end()) {
    kept.splice(kept.begin(), kept, found);
    return found->second;
  }
  kept.emplace_front(key, std::make_shared<const RaySurfaces>(device, standing,
                                                              tiles->near(standing, key.first, steps * kReachStep_m)));
  if (kept.size() > kWindowsKept) kept.pop_back();
  return kept.front().second;
}

RayWindow::RayWindow() = default;
RayWindow::RayWindow(const RayWindow&) = default;
RayWindow& RayWindow::operator=(const RayWindow&) = default;
RayWindow::~RayWindow() = default;

void RayWindow::cast_on_planes(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                               RayHit& best) const {
  for (const AnalyticSurface& plane : scene_->impl_->infinite_planes) {
    const auto hit = intersect(plane, origin, direction, min_range_m, best.range_m);
    if (hit) best = {true, hit->range_m, hit->normal_in_world.cast<float>(), plane.geom};
  }
}

void RayWindow::cast_on_movers(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                               double time_s, RayHit& best) const {
  const std::vector<MovingThing>& movers = scene_->impl_->movers;
  for (const NearMover& near : movers_) {
    if (!ray_meets_ball(origin, direction, near.centre, near.reach_m, best.range_m)) continue;
    const Pose mover_from_world = movers[near.mover].path.at(time_s).inverse();
    RayHit on_mover = best;
    on_mover.hit = false;
    movers[near.mover].surfaces->cast(mover_from_world * origin, mover_from_world.rotation * direction, min_range_m,
                                      on_mover);
    if (!on_mover.hit) continue;
    best = on_mover;
    best.normal_in_world = mover_from_world.rotation.conjugate().cast<float>() * best.normal_in_world;
  }
}

RayHit RayWindow::cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world,
                       double min_range_m, double max_range_m, double time_s) const {
  RayHit best;
  best.range_m = max_range_m;
  cast_on_planes(origin_in_world, direction_in_world, min_range_m, best);
  standing_->cast(origin_in_world, direction_in_world, min_range_m, best);
  cast_on_movers(origin_in_world, direction_in_world, min_range_m, time_s, best);
  finish(direction_in_world, best);
  return best;
}

void RayWindow::cast(const RayPacket& rays, double min_range_m, double max_range_m,
                     std::array<RayHit, RayPacket::kMost>& hits) const {
  for (std::size_t i = 0; i < rays.size; ++i) {
    hits[i] = RayHit();
    hits[i].range_m = max_range_m;
    cast_on_planes(rays.origins[i], rays.directions[i], min_range_m, hits[i]);
  }
  standing_->cast(rays, min_range_m, hits);
  for (std::size_t i = 0; i < rays.size; ++i) {
    cast_on_movers(rays.origins[i], rays.directions[i], min_range_m, rays.times_s[i], hits[i]);
    finish(rays.directions[i], hits[i]);
  }
}

RayScene::RayScene(const World& world) : impl_(std::make_unique<Impl>(world)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

RayWindow RayScene::window(const Eigen::Vector3d& place, double reach_m, double time_s) const {
  RayWindow window;
  window.scene_ = this;
  window.standing_ = impl_->standing_near(place, reach_m + RayWindow::kSlack_m);
  for (std::size_t i = 0; i < impl_->movers.size(); ++i) {
    const MovingThing& thing = impl_->movers[i];
    const Eigen::Vector3d centre = thing.path.at(time_s).translation;
    const double reach = thing.radius_m + thing.path.speed_mps() * RayWindow::kSlack_s;
    if ((centre - place).norm() <= reach_m + RayWindow::kSlack_m + reach) window.movers_.push_back({i, centre, reach});
  }
  return window;
}

RayHit RayScene::cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world,
                      double min_range_m, double max_range_m, double time_s) const {
  return window(origin_in_world, max_range_m, time_s)
      .cast(origin_in_world, direction_in_world, min_range_m, max_range_m, time_s);
}

double RayScene::distance_to_surface(const Eigen::Vector3d& point_in_world, double limit_m) const {
  double nearest = limit_m;
  for (const AnalyticSurface& plane : impl_->infinite_planes) {
    nearest = std::min(nearest, distance(plane, point_in_world));
  }
  return impl_->standing_near(point_in_world, limit_m)->distance(point_in_world, nearest);
}

}  // namespace plumbline
