#include "estimator/lidar/deskew.h"

#include <algorithm>

namespace plumbline {
namespace {

// The track is read on a grid and points are blended between its knots. At 5 rad/s a millisecond turns 5 mrad; blending
// instead of turning errs by angle^2 / 8, 0.3 mm at 100 m.
constexpr std::int64_t kKnotInterval_ns = DeskewedScan::kInterval_ns;

/// Single precision suffices: motion within one scan is metres, so a float resolves micrometres.
struct Knot {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;

  Eigen::Vector3f operator*(const Eigen::Vector3f& p) const { return rotation * p + translation; }
};

std::vector<Knot> knots_over(const LidarScan& scan, std::int64_t duration_ns, const PoseTrack& world_from_body,
                             const Pose& body_from_lidar, std::int64_t reference_ns) {
  const Pose reference_from_world = world_from_body.at(reference_ns).inverse();
  std::vector<Knot> knots;
  const std::int64_t count = duration_ns / kKnotInterval_ns + 2;
  knots.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    const Pose at_knot = world_from_body.at(scan.stamp_ns + k * kKnotInterval_ns);
    const Pose reference_from_lidar = reference_from_world * at_knot * body_from_lidar;
    knots.push_back({reference_from_lidar.rotation.toRotationMatrix().cast<float>(),
                     reference_from_lidar.translation.cast<float>()});
  }
  return knots;
}

}  // namespace

Eigen::Vector3f DeskewedScan::origin(std::int64_t offset_ns) const {
  const auto last = static_cast<std::int64_t>(origins.size()) - 1;
  const std::int64_t held = std::clamp<std::int64_t>(offset_ns, 0, last * kInterval_ns);
  const std::int64_t k = std::min(held / kInterval_ns, last - 1);
  const float ratio = static_cast<float>(held - k * kInterval_ns) / static_cast<float>(kInterval_ns);
  const Eigen::Vector3f& before = origins[static_cast<std::size_t>(k)];
  return before + ratio * (origins[static_cast<std::size_t>(k) + 1] - before);
}

DeskewedScan deskew(const LidarScan& scan, const PoseTrack& world_from_body, const Pose& body_from_lidar,
                    std::int64_t reference_ns) {
  const std::int64_t duration_ns = std::max<std::int64_t>(0, scan.end_ns - scan.stamp_ns);
  const std::vector<Knot> knots = knots_over(scan, duration_ns, world_from_body, body_from_lidar, reference_ns);
  DeskewedScan deskewed;
  deskewed.origins.reserve(knots.size());
  for (const Knot& knot : knots) deskewed.origins.push_back(knot.translation);
  deskewed.points.reserve(scan.points.size());
  for (const LidarPoint& point : scan.points) {
    const std::int64_t offset_ns = std::clamp<std::int64_t>(point.offset_ns, 0, duration_ns);
    const auto k = static_cast<std::size_t>(offset_ns / kKnotInterval_ns);
    const float ratio = static_cast<float>(offset_ns % kKnotInterval_ns) / static_cast<float>(kKnotInterval_ns);
    const Eigen::Vector3f before = knots[k] * point.position;
    const Eigen::Vector3f after = knots[k + 1] * point.position;
    deskewed.points.emplace_back(before + ratio * (after - before));
  }
  return deskewed;
}

}  // namespace plumbline
