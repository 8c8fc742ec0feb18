#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/messages.h"
#include "estimator/vision/inverse_depth.h"

namespace plumbline {

/// Standard deviation of one point's depth: constant for a time-of-flight sensor, growing with the square of the depth
/// for one that triangulates.
struct DepthNoise {
  double constant_m = 0.015;
  double per_square_m = 0.0;  ///< [1/m], times depth^2
  double at(double depth_m) const { return std::hypot(constant_m, per_square_m * depth_m * depth_m); }
};

/// Where a depth is from, which decides how sure it is (thesis 3.5).
enum class DepthSource : std::uint8_t { kNone, kLidar, kDepthImage, kStereo, kTriangulated };

struct DepthMapConfig {
  double max_age_s = 3.0;
  DepthNoise lidar;
  double angular_spacing_deg = 0.4;  ///< of the kept points; finer, and all neighbours of a ray lie on one lidar ring
  double max_neighbour_angle_deg = 2.4;  ///< between ray and neighbour: the 2 degrees between a 16-beam lidar's rings
};

struct MapDepth {
  InverseDepth depth;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  ///< the surface's: plane . X = 1 for its points X in the view [1/m]
  DepthSource source = DepthSource::kLidar;
};

/// Depth points of the last seconds, from lidar or depth images, as seen from a key-frame, asked for the depth along a
/// ray (thesis 3.3 and 5.2).
class DepthMap {
 public:
  DepthMap(const CameraIntrinsics& camera, const DepthMapConfig& config);
  DepthMap(DepthMap&&) noexcept;
  DepthMap& operator=(DepthMap&&) noexcept;
  ~DepthMap();

  /// Keeps points for later views. Where the camera looks now is known, points far outside that view are dropped at
  /// once; none that a view within 30 degrees could see.
  /// @param source  kLidar or kDepthImage
  void add(std::int64_t stamp_ns, DepthSource source, const std::vector<Eigen::Vector3f>& points_in_world,
           const std::optional<Pose>& world_from_camera);

  /// Makes the view that depth_along() reads: drops points that are too old, behind or outside the image, thins the
  /// rest to constant angular spacing, newest first, and sorts them into a 2-D tree of azimuth and polar angle.
  void look_from(const Pose& world_from_camera, std::int64_t now_ns);

  /// Inverse depth where a ray of the view (z = 1) meets the plane of three neighbouring points (3.10).
  /// Nothing where coverage is missing, the points belong to different surfaces, or the plane is seen at grazing angle.
  /// Where a nearer surface surrounds the ray it hides whatever lies behind, so the nearer one counts.
  std::optional<MapDepth> depth_along(const Eigen::Vector3d& ray) const;

  std::size_t points_in_view() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
