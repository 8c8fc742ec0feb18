#pragma once

#include <cmath>
#include <vector>

#include "estimator/geometry/so3.h"
#include "estimator/messages.h"
#include "estimator/vision/motion_constraints.h"
#include "estimator/vision/point_frame.h"
#include "sim/random_stream.h"

/// A world of identified points, seen without images: what the solvers of motion make of noisy sightings alone.
namespace plumbline::testing {

/// 640x360 at 474 px, looking along x, and the same camera 0.2 m to its right.
inline Calibration stereo_calibration() {
  Calibration calibration;
  calibration.has_lidar = false;
  calibration.camera = {640, 360, 474.0, 474.0, 319.5, 179.5};
  calibration.body_from_camera = {body_from_optical_rotation(), Eigen::Vector3d(0.12, -0.03, 0.05)};
  Pose right = calibration.body_from_camera;
  right.translation += right.rotation * Eigen::Vector3d(0.2, 0.0, 0.0);
  calibration.further_cameras = {{1, right, calibration.camera, 30.0}};
  return calibration;
}

/// Points on the walls of a hall along x, 10 m wide and 6 m high, some two a square metre.
inline std::vector<Eigen::Vector3d> hall_points(double length_m, std::uint64_t seed) {
  RandomStream random(seed, "points");
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < static_cast<int>(40.0 * length_m); ++i) {
    const double along = random.uniform(0.0, length_m + 12.0);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    if (random.uniform() < 0.6) {
      points.emplace_back(along, 5.0 * side, random.uniform(-3.0, 3.0));
    } else {
      points.emplace_back(along, random.uniform(-5.0, 5.0), 3.0 * side);
    }
  }
  return points;
}

/// Walks along the hall at 1 m/s with the sway of a walker.
inline Pose walk(double t) {
  return {exp_so3({0.02 * std::sin(5.0 * t), 0.02 * std::sin(7.0 * t), 0.15 * std::sin(0.8 * t)}),
          {t, 0.3 * std::sin(0.7 * t), 0.03 * std::sin(11.0 * t)}};
}

/// What a camera sees of them, nearer than `range_m`.
inline PointFrame see(const std::vector<Eigen::Vector3d>& points, const Pose& world_from_body,
                      const Pose& body_from_camera, const CameraIntrinsics& camera, int camera_id,
                      std::int64_t stamp_ns, double range_m, double sigma_px, RandomStream& random) {
  PointFrame frame{stamp_ns, camera_id, {}};
  const Pose camera_from_world = (world_from_body * body_from_camera).inverse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = camera_from_world * points[i];
    const Eigen::Vector2d noise(sigma_px * random.gaussian(), sigma_px * random.gaussian());
    if (p.z() < 0.5 || p.norm() > range_m) continue;
    const Eigen::Vector2d pixel = project(camera, p) + noise;
    if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1) continue;
    frame.points.push_back({static_cast<std::int64_t>(i), pixel.cast<float>()});
  }
  return frame;
}

}  // namespace plumbline::testing
