#include "estimator/vision/triangulation.h"

#include <cmath>

namespace plumbline {
namespace {

constexpr double kLeastAxisAngle = 2.0 * M_PI / 180.0;  // method section 8: the ray more than 2 degrees off the motion
constexpr double kLeastBaseline_m = 0.01;               // [m]: below, the pose's own error is all there is
constexpr double kEpipolarGate = 4.0;                   // [sigma]
constexpr double kContradiction = 4.0;                  // [sigma]
/// A baseline of 2 % of the depth (method section 8) moves a feature by 9.5 px at f = 474 px, which a track good to
/// 0.3-0.5 px turns into 3-5 % of depth.
constexpr double kConvergedRelativeSigma = 0.05;

}  // namespace

std::optional<InverseDepth> triangulate(const CameraMotion& motion, const CameraIntrinsics& camera,
                                        const FeatureSighting& feature, double motion_relative_error) {
  const Eigen::Vector3d& t = motion.camera_from_keyframe_translation;
  const Eigen::Vector3d y = motion.camera_from_keyframe_rotation * feature.keyframe_ray;
  const Eigen::Vector3d x = ray_through(camera, feature.pixel);
  const double baseline = t.norm();
  if (baseline < kLeastBaseline_m) return std::nullopt;
  if (x.cross(t).norm() < std::sin(kLeastAxisAngle) * x.norm() * baseline) return std::nullopt;

  // x (y + rho t).z = (y + rho t).xy, rows 5.6 and 5.7 divided by the key-frame depth: linear in rho. In pixels.
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const Eigen::Vector2d slope = focal.cwiseProduct(x.head<2>() * t.z() - t.head<2>());
  const Eigen::Vector2d offset = focal.cwiseProduct(y.head<2>() - x.head<2>() * y.z());
  InverseDepth depth;
  depth.mean = slope.dot(offset) / slope.squaredNorm();
  const double depth_ratio = y.z() + depth.mean * t.z();  // z^c / z^l
  if (depth_ratio <= 0.0) return std::nullopt;
  const double off_line_px = (offset - depth.mean * slope).norm() / depth_ratio;
  if (off_line_px > kEpipolarGate * feature.pixel_sigma) return std::nullopt;
  depth.sigma = std::hypot(feature.pixel_sigma * depth_ratio / slope.norm(), motion_relative_error * depth.mean);
  return depth;
}

InverseDepth fuse(const InverseDepth& older, const InverseDepth& newer) {
  if (!std::isfinite(older.sigma)) return newer;
  if (std::abs(older.mean - newer.mean) > kContradiction * std::hypot(older.sigma, newer.sigma)) return newer;
  const double older_weight = 1.0 / (older.sigma * older.sigma);
  const double newer_weight = 1.0 / (newer.sigma * newer.sigma);
  InverseDepth fused;
  fused.mean = (older_weight * older.mean + newer_weight * newer.mean) / (older_weight + newer_weight);
  fused.sigma = 1.0 / std::sqrt(older_weight + newer_weight);
  return fused;
}

InverseDepth carried_along(const InverseDepth& in_keyframe, const CameraMotion& motion,
                           const Eigen::Vector3d& keyframe_ray) {
  // z^c = (R X-bar).z z^l + t.z, so rho^c = rho^l / (a + rho^l t.z) and d rho^c / d rho^l = a / (a + rho^l t.z)^2.
  const double a = motion.camera_from_keyframe_rotation.row(2).dot(keyframe_ray);
  const double ratio = a + in_keyframe.mean * motion.camera_from_keyframe_translation.z();
  if (!std::isfinite(in_keyframe.sigma) || a <= 0.0 || ratio <= 0.0) return {};
  return {in_keyframe.mean / ratio, in_keyframe.sigma * a / (ratio * ratio)};
}

bool converged(const InverseDepth& depth) {
  return depth.known() && depth.sigma < kConvergedRelativeSigma * depth.mean;
}

}  // namespace plumbline
