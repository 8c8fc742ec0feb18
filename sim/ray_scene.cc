#include "sim/ray_scene.h"

#include <embree3/rtcore.h>
#include <mujoco/mujoco.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/analytic_surfaces.h"
#include "sim/geom_mesh.h"
#include "sim/triangle_soup.h"

namespace plumbline {
namespace {

// Embree works in float about the scene's centre. At 5 km from it a coordinate is off by 0.25 mm; boxes and query radii
// are padded by more than that, so that nothing is missed, and what is found is computed again in double.
constexpr double kFloatPadding_m = 1e-3;

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using Scene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;
using Geometry = std::unique_ptr<RTCGeometryTy, EmbreeRelease>;

// Embree reports through a C callback, which must not throw: the first message is kept until throw_if_failed.
class ErrorLog {
 public:
  static void record(void* log, RTCError /*code*/, const char* message) {
    auto& first = static_cast<ErrorLog*>(log)->message_;
    if (first.empty()) first = message;
  }
  void throw_if_failed() const {
    if (!message_.empty()) throw std::runtime_error("Embree: " + message_);
  }

 private:
  std::string message_;
};

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

// The ray in double, handed through Embree to the analytic surfaces' callback.
struct RayQuery : RTCIntersectContext {
  Eigen::Vector3d origin_in_world;
  Eigen::Vector3d direction_in_world;
};

struct DistanceQuery {
  const TriangleSoup& triangles;
  const std::vector<AnalyticSurface>& surfaces;
  unsigned triangle_geometry;
  Eigen::Vector3d point_in_world;
  double nearest_m;
};

}  // namespace

struct RayScene::Impl {
  explicit Impl(const World& world);

  RayHit hit_of(const RTCRayHit& found, const RayQuery& query) const;

  ErrorLog errors;
  Device device;
  Scene scene;
  unsigned triangle_geometry = RTC_INVALID_GEOMETRY_ID;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< origin of Embree's coordinates, in the world
  TriangleSoup triangles;
  std::vector<AnalyticSurface> surfaces;  ///< bounded
  std::vector<AnalyticSurface> infinite_planes;

 private:
  void add_geoms(const World& world);
  void centre_on_geometry();
  void attach_triangles();
  void attach_surfaces();
  void commit();

  static void surface_bounds(const RTCBoundsFunctionArguments* arguments);
  static void intersect_surface(const RTCIntersectFunctionNArguments* arguments);
};

RayScene::Impl::Impl(const World& world) {
  device.reset(rtcNewDevice(nullptr));
  if (!device) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(device.get(), &ErrorLog::record, &errors);
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // no leaks along shared edges
  add_geoms(world);
  centre_on_geometry();
  attach_triangles();
  attach_surfaces();
  commit();
}

void RayScene::Impl::add_geoms(const World& world) {
  constexpr double kUnused = 1.0;  // tolerance and extent, of types that do not come here
  const mjModel& model = world.model();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_bodyid[geom] == world.rig_body() || is_transparent(model, geom)) continue;
    const Eigen::Vector3d position = Eigen::Map<const Eigen::Vector3d>(world.data().geom_xpos + 3L * geom);
    const Eigen::Matrix3d rotation =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(world.data().geom_xmat + 9L * geom);
    if (!is_analytic(model.geom_type[geom])) {
      triangles.append(mesh_of_geom(model, geom, kUnused, kUnused), rotation, position, geom);
      continue;
    }
    const AnalyticSurface surface{kind_of(model.geom_type[geom]),
                                  Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3L * geom), rotation, position,
                                  geom};
    (is_bounded(surface) ? surfaces : infinite_planes).push_back(surface);
  }
}

void RayScene::Impl::centre_on_geometry() {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : triangles.vertices()) bounds.extend(vertex);
  for (const AnalyticSurface& surface : surfaces) bounds.extend(bounds_in_world(surface));
  if (!bounds.isEmpty()) centre = bounds.center();
}

void RayScene::Impl::attach_triangles() {
  if (triangles.triangles().empty()) return;
  const Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertex = static_cast<Eigen::Vector3f*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                       RTC_FORMAT_FLOAT3, sizeof(Eigen::Vector3f),
                                                                       triangles.vertices().size()));
  auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0,
                                                                    RTC_FORMAT_UINT3, sizeof(TriangleSoup::Triangle),
                                                                    triangles.triangles().size()));
  errors.throw_if_failed();
  for (const Eigen::Vector3d& in_world : triangles.vertices()) *vertex++ = (in_world - centre).cast<float>();
  for (const TriangleSoup::Triangle& triangle : triangles.triangles())
    index = std::copy(triangle.begin(), triangle.end(), index);
  rtcCommitGeometry(geometry.get());
  triangle_geometry = rtcAttachGeometry(scene.get(), geometry.get());
}

void RayScene::Impl::attach_surfaces() {
  if (surfaces.empty()) return;
  const Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(surfaces.size()));
  rtcSetGeometryUserData(geometry.get(), this);
  rtcSetGeometryBoundsFunction(geometry.get(), &Impl::surface_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &Impl::intersect_surface);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
}

// On one thread: the tree's order, which decides between surfaces at the same range, must not depend on the machine's
// load. (Embree's own `threads=1` would bind the whole process for the device's life.)
void RayScene::Impl::commit() {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  rtcCommitScene(scene.get());
  errors.throw_if_failed();
}

void RayScene::Impl::surface_bounds(const RTCBoundsFunctionArguments* arguments) {
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  const Eigen::AlignedBox3d box = bounds_in_world(self.surfaces[arguments->primID]);
  const Eigen::Array3f lower = (box.min() - self.centre).array().cast<float>() - static_cast<float>(kFloatPadding_m);
  const Eigen::Array3f upper = (box.max() - self.centre).array().cast<float>() + static_cast<float>(kFloatPadding_m);
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = lower.x();
  bounds.lower_y = lower.y();
  bounds.lower_z = lower.z();
  bounds.upper_x = upper.x();
  bounds.upper_y = upper.y();
  bounds.upper_z = upper.z();
}

void RayScene::Impl::intersect_surface(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;  // one ray at a time: only rtcIntersect1 is called
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  const auto& query = *static_cast<const RayQuery*>(arguments->context);
  auto& found = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const auto surface_hit = intersect(self.surfaces[arguments->primID], query.origin_in_world, query.direction_in_world,
                                     found.ray.tnear, found.ray.tfar);
  if (!surface_hit) return;
  found.ray.tfar = static_cast<float>(surface_hit->range_m);
  found.hit.geomID = arguments->geomID;
  found.hit.primID = arguments->primID;
}

// What Embree found, in double.
RayHit RayScene::Impl::hit_of(const RTCRayHit& found, const RayQuery& query) const {
  const Eigen::Vector3d& origin = query.origin_in_world;
  const Eigen::Vector3d& direction = query.direction_in_world;
  const std::uint32_t primitive = found.hit.primID;
  if (found.hit.geomID == triangle_geometry) {
    return {true, triangles.refined_range(primitive, origin, direction, found.ray.tfar),
            triangles.unit_normal(primitive).cast<float>(), triangles.geom_of(primitive)};
  }
  const AnalyticSurface& surface = surfaces[primitive];
  // The callback's answer was rounded to float; asking again without its upper limit gives the same crossing in full.
  const auto hit = intersect(surface, origin, direction, found.ray.tnear, std::numeric_limits<double>::infinity());
  return {true, hit->range_m, hit->normal_in_world.cast<float>(), surface.geom};
}

RayScene::RayScene(const World& world) : impl_(std::make_unique<Impl>(world)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

RayWindow RayScene::window(const Eigen::Vector3d& /*place*/, double /*reach_m*/) const { return RayWindow(*this); }

RayHit RayWindow::cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world,
                       double min_range_m, double max_range_m, double time_s) const {
  return scene_->cast(origin_in_world, direction_in_world, min_range_m, max_range_m, time_s);
}

RayHit RayScene::cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world,
                      double min_range_m, double max_range_m, double /*time_s*/) const {
  RayHit best;
  best.range_m = max_range_m;
  for (const AnalyticSurface& plane : impl_->infinite_planes) {
    const auto hit = intersect(plane, origin_in_world, direction_in_world, min_range_m, best.range_m);
    if (hit) best = {true, hit->range_m, hit->normal_in_world.cast<float>(), plane.geom};
  }

  RayQuery query;
  rtcInitIntersectContext(&query);
  query.origin_in_world = origin_in_world;
  query.direction_in_world = direction_in_world;
  RTCRayHit found{};
  const Eigen::Vector3f origin = (origin_in_world - impl_->centre).cast<float>();
  const Eigen::Vector3f direction = direction_in_world.cast<float>();
  found.ray = {origin.x(),
               origin.y(),
               origin.z(),
               static_cast<float>(min_range_m),
               direction.x(),
               direction.y(),
               direction.z(),
               0.0F,
               static_cast<float>(best.range_m),
               ~0U,
               0U,
               0U};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene.get(), &query, &found);
  if (found.hit.geomID != RTC_INVALID_GEOMETRY_ID) best = impl_->hit_of(found, query);

  if (!best.hit) return {};
  if (best.normal_in_world.dot(direction) > 0.0F) best.normal_in_world = -best.normal_in_world;
  return best;
}

double RayScene::distance_to_surface(const Eigen::Vector3d& point_in_world, double limit_m) const {
  DistanceQuery query{impl_->triangles, impl_->surfaces, impl_->triangle_geometry, point_in_world, limit_m};
  for (const AnalyticSurface& plane : impl_->infinite_planes) {
    query.nearest_m = std::min(query.nearest_m, distance(plane, point_in_world));
  }
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    auto& asked = *static_cast<DistanceQuery*>(arguments->userPtr);
    const double here = arguments->geomID == asked.triangle_geometry
                            ? asked.triangles.distance(arguments->primID, asked.point_in_world)
                            : distance(asked.surfaces[arguments->primID], asked.point_in_world);
    if (here >= asked.nearest_m) return false;
    asked.nearest_m = here;
    arguments->query->radius = static_cast<float>(here + kFloatPadding_m);
    return true;  // the radius has shrunk
  };
  const Eigen::Vector3f point = (point_in_world - impl_->centre).cast<float>();
  RTCPointQuery around{point.x(), point.y(), point.z(), 0.0F, static_cast<float>(query.nearest_m + kFloatPadding_m)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene.get(), &around, &context, visit, &query);
  return query.nearest_m;
}

}  // namespace plumbline
