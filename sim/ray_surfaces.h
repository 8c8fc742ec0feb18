#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/analytic_surfaces.h"
#include "sim/embree_device.h"
#include "sim/ray_hit.h"
#include "sim/ray_packet.h"
#include "sim/triangle_soup.h"

namespace plumbline {

/// Surfaces in one frame, which is the world's or a mover's.
struct SurfaceLists {
  TriangleSoup triangles;
  std::vector<AnalyticSurface> bounded;
};

/// Which of the lists' triangles and bounded surfaces; both in increasing order.
struct SurfaceSelection {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> bounded;
};

SurfaceSelection all_of(const SurfaceLists& lists);

/// A part of the lists as Embree has it, in float32 about the part's own centre; what is found there is computed again
/// in double. Casting is safe from several threads at once.
class RaySurfaces {
 public:
  /// Built by the calling thread alone: the tree's order, which decides between surfaces at the same range, must not
  /// depend on the machine's load. Device and lists must outlive this.
  RaySurfaces(const EmbreeDevice& device, const SurfaceLists& lists, SurfaceSelection selection);
  RaySurfaces(const RaySurfaces&) = delete;
  RaySurfaces& operator=(const RaySurfaces&) = delete;
  ~RaySurfaces();

  /// The first surface along a ray within [min_range_m, best.range_m] takes the place of `best`. The normal's side is
  /// the surface's own.
  void cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m, RayHit& best) const;
  /// The same for each of the packet's rays.
  void cast(const RayPacket& rays, double min_range_m, std::array<RayHit, RayPacket::kMost>& best) const;
  /// The distance to the nearest surface, at most limit_m.
  double distance(const Eigen::Vector3d& point, double limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
