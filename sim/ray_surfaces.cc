#include "sim/ray_surfaces.h"

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace plumbline {
namespace {

// Embree works in float about the part's centre. At 5 km from it a coordinate is off by 0.25 mm; boxes and query radii
// are padded by more than that, so that nothing is missed, and what is found is computed again in double.
constexpr double kFloatPadding_m = 1e-3;
// Seen flatter than this, a plane answers far off for an error in the last digit.
constexpr double kGrazing = 0.02;

struct EmbreeRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Scene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;
using Geometry = std::unique_ptr<RTCGeometryTy, EmbreeRelease>;

// What a hit on a triangle needs, in one cache line.
struct Facet {
  Eigen::Vector3d normal;  ///< unit
  double offset = 0.0;     ///< normal . x = offset
  int geom = -1;
};

// The ray in double, handed through Embree to the analytic surfaces' callback.
struct RayQuery : RTCIntersectContext {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

}  // namespace

struct RaySurfaces::Impl {
  Impl(const EmbreeDevice& device, const SurfaceLists& all, SurfaceSelection chosen);

  void centre_on_selection();
  void attach_triangles(RTCDevice device);
  void attach_bounded(RTCDevice device);
  RayHit hit_of(const RTCRayHit& found, const RayQuery& query) const;
  const AnalyticSurface& surface(std::uint32_t primitive) const { return lists.bounded[selection.bounded[primitive]]; }

  static void surface_bounds(const RTCBoundsFunctionArguments* arguments);
  static void intersect_surface(const RTCIntersectFunctionNArguments* arguments);

  const SurfaceLists& lists;
  SurfaceSelection selection;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<Facet> facets;  ///< as selection.triangles
  unsigned triangle_geometry = RTC_INVALID_GEOMETRY_ID;
  Scene scene;
};

RaySurfaces::Impl::Impl(const EmbreeDevice& device, const SurfaceLists& all, SurfaceSelection chosen)
    : lists(all), selection(std::move(chosen)), scene(rtcNewScene(device.get())) {
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // no leaks along shared edges
  centre_on_selection();
  attach_triangles(device.get());
  attach_bounded(device.get());
  device.throw_if_failed();
  // Embree's own `threads=1` would bind the whole process for the device's life.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  rtcCommitScene(scene.get());
  device.throw_if_failed();
}

void RaySurfaces::Impl::centre_on_selection() {
  Eigen::AlignedBox3d bounds;
  for (const std::uint32_t triangle : selection.triangles) {
    for (const std::uint32_t corner : lists.triangles.triangles()[triangle]) {
      bounds.extend(lists.triangles.vertices()[corner]);
    }
  }
  for (const std::uint32_t i : selection.bounded) bounds.extend(bounds_in_world(lists.bounded[i]));
  if (!bounds.isEmpty()) centre = bounds.center();
}

void RaySurfaces::Impl::attach_triangles(RTCDevice device) {
  const std::size_t count = selection.triangles.size();
  if (count == 0) return;
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertex = static_cast<Eigen::Vector3f*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Eigen::Vector3f), 3 * count));
  auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(TriangleSoup::Triangle), count));
  if (vertex == nullptr || index == nullptr) return;  // the device has kept the reason
  std::iota(index, index + 3 * count, 0U);
  facets.reserve(count);
  for (const std::uint32_t triangle : selection.triangles) {
    const TriangleSoup::Triangle& corners = lists.triangles.triangles()[triangle];
    for (const std::uint32_t corner : corners) {
      *vertex++ = (lists.triangles.vertices()[corner] - centre).cast<float>();
    }
    const Eigen::Vector3d normal = lists.triangles.unit_normal(triangle);
    facets.push_back({normal, normal.dot(lists.triangles.vertices()[corners[0]]), lists.triangles.geom_of(triangle)});
  }
  rtcCommitGeometry(geometry.get());
  triangle_geometry = rtcAttachGeometry(scene.get(), geometry.get());
}

void RaySurfaces::Impl::attach_bounded(RTCDevice device) {
  if (selection.bounded.empty()) return;
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(selection.bounded.size()));
  rtcSetGeometryUserData(geometry.get(), this);
  rtcSetGeometryBoundsFunction(geometry.get(), &Impl::surface_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &Impl::intersect_surface);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
}

void RaySurfaces::Impl::surface_bounds(const RTCBoundsFunctionArguments* arguments) {
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  const Eigen::AlignedBox3d box = bounds_in_world(self.surface(arguments->primID));
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

void RaySurfaces::Impl::intersect_surface(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;  // one ray at a time: only rtcIntersect1 is called
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  const auto& query = *static_cast<const RayQuery*>(arguments->context);
  auto& found = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const auto surface_hit =
      intersect(self.surface(arguments->primID), query.origin, query.direction, found.ray.tnear, found.ray.tfar);
  if (!surface_hit) return;
  found.ray.tfar = static_cast<float>(surface_hit->range_m);
  found.hit.geomID = arguments->geomID;
  found.hit.primID = arguments->primID;
}

// What Embree found, in double.
RayHit RaySurfaces::Impl::hit_of(const RTCRayHit& found, const RayQuery& query) const {
  const std::uint32_t primitive = found.hit.primID;
  if (found.hit.geomID == triangle_geometry) {
    const Facet& facet = facets[primitive];
    const double closing = facet.normal.dot(query.direction);
    const double range = std::abs(closing) > kGrazing
                             ? (facet.offset - facet.normal.dot(query.origin)) / closing
                             : lists.triangles.refined_range(selection.triangles[primitive], query.origin,
                                                             query.direction, found.ray.tfar);
    return {true, range, facet.normal.cast<float>(), facet.geom};
  }
  // The callback's answer was rounded to float; asking again without its upper limit gives the same crossing in full.
  const auto hit = intersect(surface(primitive), query.origin, query.direction, found.ray.tnear,
                             std::numeric_limits<double>::infinity());
  return {true, hit->range_m, hit->normal_in_world.cast<float>(), surface(primitive).geom};
}

RaySurfaces::RaySurfaces(const EmbreeDevice& device, const SurfaceLists& lists, SurfaceSelection selection)
    : impl_(std::make_unique<Impl>(device, lists, std::move(selection))) {}

RaySurfaces::~RaySurfaces() = default;

void RaySurfaces::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                       RayHit& best) const {
  RayQuery query;
  rtcInitIntersectContext(&query);
  query.origin = origin;
  query.direction = direction;
  RTCRayHit found;
  const Eigen::Vector3f from = (origin - impl_->centre).cast<float>();
  const Eigen::Vector3f towards = direction.cast<float>();
  found.ray = {from.x(),    from.y(),    from.z(), static_cast<float>(min_range_m),  towards.x(),
               towards.y(), towards.z(), 0.0F,     static_cast<float>(best.range_m), ~0U,
               0U,          0U};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene.get(), &query, &found);
  if (found.hit.geomID != RTC_INVALID_GEOMETRY_ID) best = impl_->hit_of(found, query);
}

double RaySurfaces::distance(const Eigen::Vector3d& point, double limit_m) const {
  struct Query {
    const Impl& self;
    Eigen::Vector3d point;
    double nearest_m;
  };
  Query query{*impl_, point, limit_m};
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    auto& asked = *static_cast<Query*>(arguments->userPtr);
    const Impl& self = asked.self;
    const double here = arguments->geomID == self.triangle_geometry
                            ? self.lists.triangles.distance(self.selection.triangles[arguments->primID], asked.point)
                            : plumbline::distance(self.surface(arguments->primID), asked.point);
    if (here >= asked.nearest_m) return false;
    asked.nearest_m = here;
    arguments->query->radius = static_cast<float>(here + kFloatPadding_m);
    return true;  // the radius has shrunk
  };
  const Eigen::Vector3f from = (point - impl_->centre).cast<float>();
  RTCPointQuery around{from.x(), from.y(), from.z(), 0.0F, static_cast<float>(limit_m + kFloatPadding_m)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene.get(), &around, &context, visit, &query);
  return query.nearest_m;
}

SurfaceSelection all_of(const SurfaceLists& lists) {
  SurfaceSelection all;
  all.triangles.resize(lists.triangles.triangles().size());
  all.bounded.resize(lists.bounded.size());
  std::iota(all.triangles.begin(), all.triangles.end(), 0U);
  std::iota(all.bounded.begin(), all.bounded.end(), 0U);
  return all;
}

}  // namespace plumbline
