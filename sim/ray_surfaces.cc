#include "sim/ray_surfaces.h"

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
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
struct alignas(64) Facet {
  Eigen::Vector3d normal;  ///< unit
  double offset = 0.0;     ///< normal . x = offset
  int geom = -1;
};

// Where surfaces are at the same distance to the last bits, the order in which they are visited decides which counts. A
// packet visits them in another order than a ray alone, so it looks a little beyond the nearest and says which of its
// rays met two there.
class TieWatch {
 public:
  void begin(std::size_t ray, float limit_m) { nearest_m_[ray] = limit_m; }
  /// A surface within search_limit_m.
  void note(std::size_t ray, float range_m) {
    is_tied_[ray] = range_m >= nearest_m_[ray] * (1.0F - kAlike);
    nearest_m_[ray] = std::min(nearest_m_[ray], range_m);
  }
  float search_limit_m(std::size_t ray) const { return nearest_m_[ray] * (1.0F + kAlike); }
  float nearest_m(std::size_t ray) const { return nearest_m_[ray]; }
  bool is_tied(std::size_t ray) const { return is_tied_[ray]; }

 private:
  static constexpr float kAlike = 1e-6F;

  std::array<float, RayPacket::kMost> nearest_m_;
  std::array<bool, RayPacket::kMost> is_tied_ = {};
};

// The rays in double, handed through Embree to the analytic surfaces' callback; which is which, their ids say.
struct RayQuery : RTCIntersectContext {
  const Eigen::Vector3d* origins = nullptr;
  const Eigen::Vector3d* directions = nullptr;
  TieWatch* ties = nullptr;  ///< of a packet
};

// Embree's filter of a packet, to which every triangle comes that is within the limit so far.
void note_triangle(const RTCFilterFunctionNArguments* arguments) {
  TieWatch& ties = *static_cast<RayQuery*>(arguments->context)->ties;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned id = RTCRayN_id(arguments->ray, arguments->N, i);
    float& limit_m = RTCRayN_tfar(arguments->ray, arguments->N, i);
    ties.note(id, limit_m);
    limit_m = ties.search_limit_m(id);
  }
}

// What Embree says of a ray that met something.
struct FoundPrimitive {
  unsigned geometry = RTC_INVALID_GEOMETRY_ID;
  unsigned primitive = 0;
  float from_m = 0.0F;
  float range_m = 0.0F;
};

}  // namespace

struct RaySurfaces::Impl {
  Impl(const EmbreeDevice& device, const SurfaceLists& all, SurfaceSelection chosen);

  void centre_on_selection();
  void attach_triangles(RTCDevice device);
  void attach_bounded(RTCDevice device);
  RayHit hit_of(const FoundPrimitive& found, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
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
  // No leaks along shared edges; packets watch for ties.
  rtcSetSceneFlags(scene.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
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
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  const auto& query = *static_cast<const RayQuery*>(arguments->context);
  const unsigned count = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, count);
  for (unsigned i = 0; i < count; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned id = RTCRayN_id(rays, count, i);
    const auto surface_hit = intersect(self.surface(arguments->primID), query.origins[id], query.directions[id],
                                       RTCRayN_tnear(rays, count, i), RTCRayN_tfar(rays, count, i));
    if (!surface_hit) continue;
    const auto range_m = static_cast<float>(surface_hit->range_m);
    if (query.ties) query.ties->note(id, range_m);
    RTCRayN_tfar(rays, count, i) = query.ties ? query.ties->search_limit_m(id) : range_m;
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
    RTCHitN_primID(hits, count, i) = arguments->primID;
  }
}

// What Embree found, in double.
RayHit RaySurfaces::Impl::hit_of(const FoundPrimitive& found, const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction) const {
  if (found.geometry == triangle_geometry) {
    const Facet& facet = facets[found.primitive];
    const double closing = facet.normal.dot(direction);
    const double range =
        std::abs(closing) > kGrazing
            ? (facet.offset - facet.normal.dot(origin)) / closing
            : lists.triangles.refined_range(selection.triangles[found.primitive], origin, direction, found.range_m);
    return {true, range, facet.normal.cast<float>(), facet.geom};
  }
  // The callback's answer was rounded to float; asking again without its upper limit gives the same crossing in full.
  const auto hit =
      intersect(surface(found.primitive), origin, direction, found.from_m, std::numeric_limits<double>::infinity());
  return {true, hit->range_m, hit->normal_in_world.cast<float>(), surface(found.primitive).geom};
}

RaySurfaces::RaySurfaces(const EmbreeDevice& device, const SurfaceLists& lists, SurfaceSelection selection)
    : impl_(std::make_unique<Impl>(device, lists, std::move(selection))) {}

RaySurfaces::~RaySurfaces() = default;

void RaySurfaces::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                       RayHit& best) const {
  RayQuery query;
  rtcInitIntersectContext(&query);
  query.origins = &origin;
  query.directions = &direction;
  RTCRayHit found;
  const Eigen::Vector3f from = (origin - impl_->centre).cast<float>();
  const Eigen::Vector3f towards = direction.cast<float>();
  found.ray = {from.x(),    from.y(),    from.z(), static_cast<float>(min_range_m),  towards.x(),
               towards.y(), towards.z(), 0.0F,     static_cast<float>(best.range_m), ~0U,
               0U,          0U};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene.get(), &query, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  best = impl_->hit_of({found.hit.geomID, found.hit.primID, found.ray.tnear, found.ray.tfar}, origin, direction);
}

// A ray's distance to a triangle is the same to the last bit in a packet as alone; between triangles, TieWatch decides.
void RaySurfaces::cast(const RayPacket& rays, double min_range_m, std::array<RayHit, RayPacket::kMost>& best) const {
  static_assert(RayPacket::kMost == 8, "as rtcIntersect8");
  TieWatch ties;
  RayQuery query;
  rtcInitIntersectContext(&query);
  query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  query.filter = &note_triangle;
  query.ties = &ties;
  query.origins = rays.origins.data();
  query.directions = rays.directions.data();
  alignas(32) std::array<int, RayPacket::kMost> valid;
  RTCRayHit8 found;
  for (std::size_t i = 0; i < RayPacket::kMost; ++i) {
    const std::size_t from_ray = i < rays.size ? i : 0;  // the rest of the packet holds nothing odd
    const Eigen::Vector3f from = (rays.origins[from_ray] - impl_->centre).cast<float>();
    const Eigen::Vector3f towards = rays.directions[from_ray].cast<float>();
    valid[i] = i < rays.size ? -1 : 0;
    found.ray.org_x[i] = from.x();
    found.ray.org_y[i] = from.y();
    found.ray.org_z[i] = from.z();
    found.ray.tnear[i] = static_cast<float>(min_range_m);
    found.ray.dir_x[i] = towards.x();
    found.ray.dir_y[i] = towards.y();
    found.ray.dir_z[i] = towards.z();
    found.ray.time[i] = 0.0F;
    ties.begin(i, static_cast<float>(best[from_ray].range_m));
    found.ray.tfar[i] = ties.search_limit_m(i);
    found.ray.mask[i] = ~0U;
    found.ray.id[i] = static_cast<unsigned>(i);
    found.ray.flags[i] = 0U;
    found.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid.data(), impl_->scene.get(), &query, &found);
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (found.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    if (ties.is_tied(i)) {
      cast(rays.origins[i], rays.directions[i], min_range_m, best[i]);
    } else {
      best[i] = impl_->hit_of({found.hit.geomID[i], found.hit.primID[i], found.ray.tnear[i], ties.nearest_m(i)},
                              rays.origins[i], rays.directions[i]);
    }
  }
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
