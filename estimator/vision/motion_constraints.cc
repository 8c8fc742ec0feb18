#include "estimator/vision/motion_constraints.h"

#include <cmath>

namespace plumbline {
namespace {

/// Residual of a point with no projection: an outlier to any robust scale.
constexpr double kHopeless = 1e3;
/// Below this translation an epipolar line has no direction that noise would not turn.
constexpr double kLeastEpipolarBaseline = 1e-3;

struct ScaledPoint {
  Eigen::Vector3d point;  ///< h = R X-bar + t / z: the feature in the camera now, divided by its key-frame depth
  bool in_front = false;
};

ScaledPoint scaled_point(const CameraMotion& motion, const FeatureSighting& feature) {
  ScaledPoint h;
  h.point = motion.camera_from_keyframe_rotation * feature.keyframe_ray +
            feature.depth.mean * motion.camera_from_keyframe_translation;
  h.in_front = h.point.z() > kLeastDepthRatio;
  return h;
}

/// The inverse square root of C = sigma^2 I + g g^T, g being the pixel shift of one sigma of inverse depth.
Eigen::Matrix2d inverse_square_root(double pixel_sigma, const Eigen::Vector2d& g) {
  const double ratio = g.squaredNorm() / (pixel_sigma * pixel_sigma);
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity() / pixel_sigma;
  if (ratio < 1e-12) return whitening;
  const Eigen::Vector2d direction = g.normalized();
  whitening -= (1.0 - 1.0 / std::sqrt(1.0 + ratio)) / pixel_sigma * direction * direction.transpose();
  return whitening;
}

}  // namespace

CameraMotion camera_motion(const Pose& keyframe_from_body, const Pose& body_from_camera) {
  const Pose camera_from_keyframe = body_from_camera.inverse() * keyframe_from_body.inverse() * body_from_camera;
  CameraMotion motion;
  motion.camera_from_keyframe_rotation = camera_from_keyframe.rotation.toRotationMatrix();
  motion.camera_from_keyframe_translation = camera_from_keyframe.translation;
  motion.body_from_camera_rotation = body_from_camera.rotation.toRotationMatrix();
  motion.lever = motion.body_from_camera_rotation.transpose() * body_from_camera.translation;
  return motion;
}

Eigen::Vector2d project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera) {
  return {camera.fx * point_in_camera.x() / point_in_camera.z() + camera.cx,
          camera.fy * point_in_camera.y() / point_in_camera.z() + camera.cy};
}

Eigen::Matrix<double, 2, 3> d_pixel_d_point(const CameraIntrinsics& camera, const Eigen::Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  Eigen::Matrix<double, 2, 3> d;
  d << camera.fx * inverse_z, 0.0, -camera.fx * point.x() * inverse_z * inverse_z,  //
      0.0, camera.fy * inverse_z, -camera.fy * point.y() * inverse_z * inverse_z;
  return d;
}

Eigen::Vector3d ray_through(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 1.0};
}

Eigen::Matrix2d reprojection_whitening(const CameraMotion& motion, const CameraIntrinsics& camera,
                                       const FeatureSighting& feature) {
  const ScaledPoint h = scaled_point(motion, feature);
  if (!h.in_front) return Eigen::Matrix2d::Identity() / feature.pixel_sigma;
  const Eigen::Vector2d pixel_per_inverse_depth =
      d_pixel_d_point(camera, h.point) * motion.camera_from_keyframe_translation;
  return inverse_square_root(feature.pixel_sigma, pixel_per_inverse_depth * feature.depth.sigma);
}

PixelRows reprojection_rows(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature,
                            const Eigen::Matrix2d& whitening) {
  PixelRows rows;
  const ScaledPoint h = scaled_point(motion, feature);
  if (!h.in_front) {
    rows.residual.setConstant(kHopeless);
    return rows;
  }
  rows.residual = whitening * (project(camera, h.point) - feature.pixel);
  // dh = (h + lever / z) x phi - v / z, with the body's perturbation (phi, v) turned into the camera's axes.
  const Eigen::Matrix<double, 2, 3> a = whitening * d_pixel_d_point(camera, h.point);
  const Eigen::Vector3d arm = h.point + feature.depth.mean * motion.lever;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d row = a.row(i).transpose();
    rows.jacobian.block<1, 3>(i, 0) = (motion.body_from_camera_rotation * row.cross(arm)).transpose();
    rows.jacobian.block<1, 3>(i, 3) = (-feature.depth.mean * (motion.body_from_camera_rotation * row)).transpose();
  }
  return rows;
}

PixelRow epipolar_row(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature) {
  const Eigen::Vector3d& t = motion.camera_from_keyframe_translation;
  const Eigen::Vector3d y = motion.camera_from_keyframe_rotation * feature.keyframe_ray;
  const Eigen::Vector3d x = ray_through(camera, feature.pixel);
  const Eigen::Vector3d line = t.cross(y);  // 5.8 reads x . (t x R X-bar) = 0
  const Eigen::Vector3d line_per_px2(line.x() / (camera.fx * camera.fx), line.y() / (camera.fy * camera.fy), 0.0);
  const double floor = kLeastEpipolarBaseline / camera.fx;
  const double norm = std::sqrt(line.dot(line_per_px2) + floor * floor);

  PixelRow row;
  row.residual = x.dot(line) / (norm * feature.pixel_sigma);
  // d line = dt x y + t x dy, with dy = y x phi and dt = (t + lever) x phi - v in the camera's axes.
  const Eigen::Vector3d c = x / (norm * feature.pixel_sigma) - row.residual / (norm * norm) * line_per_px2;
  const Eigen::Vector3d d_t = y.cross(c);
  const Eigen::Vector3d d_y = c.cross(t);
  row.jacobian.head<3>() = motion.body_from_camera_rotation * (d_t.cross(t + motion.lever) + d_y.cross(y));
  row.jacobian.tail<3>() = -(motion.body_from_camera_rotation * d_t);
  return row;
}

double parallax_px(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature) {
  const Eigen::Vector3d rotated = motion.camera_from_keyframe_rotation * feature.keyframe_ray;
  if (rotated.z() <= kLeastDepthRatio) return 0.0;
  return (project(camera, rotated) - feature.pixel).norm();
}

}  // namespace plumbline
