#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/lens_distortion.h"
#include "estimator/geometry/pose.h"

/// What a robot's drivers deliver. Times are integer nanoseconds; units SI; frames REP-103 except the camera's.
///
/// Frames: W world (z up); B body = IMU (x forward, y left, z up); L lidar (x forward, y left, z up);
/// C camera (optical: x right, y down, z forward).
namespace plumbline {

/// Mean angular rate and specific force over the interval that ends at stamp_ns, in B.
/// A resting accelerometer reads +9.81 m/s^2 upward.
struct ImuSample {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    ///< [rad/s]
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// An 8-bit grey image, row-major without padding, stamped at the middle of its exposure.
/// Pixel (u, v) has its centre at integer coordinates; (0, 0) is the top left pixel's centre.
struct CameraFrame {
  std::int64_t stamp_ns = 0;
  int camera_id = 0;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Depth along the optical axis [m], row-major; 0 or NaN where there is none.
struct DepthFrame {
  std::int64_t stamp_ns = 0;
  int camera_id = 0;
  int width = 0;
  int height = 0;
  std::vector<float> depth_m;
};

/// One lidar return, in L as L stood at the return's own time.
struct LidarPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m]
  std::int32_t offset_ns = 0;                          ///< time since LidarScan::stamp_ns
  std::uint16_t ring = 0;                              ///< beam, counted from the lowest
  float intensity = 0.0F;                              ///< [0, 1]
};

/// Points in firing order; raw, not de-skewed. Of a spinning lidar one revolution. A scanner turned by a motor (2-axis)
/// sends its sweep in parts, and a ring is one line of the scanner, counted from the sweep's start.
struct LidarScan {
  std::int64_t stamp_ns = 0;  ///< of the first firing
  std::int64_t end_ns = 0;    ///< of the time it covers; the scan is delivered then
  std::vector<LidarPoint> points;
  std::int64_t sweep = 0;  ///< which sweep it is part of
  bool ends_sweep = true;  ///< the last part, which may have no points left to tell of
};

/// u = fx x' + cx, v = fy y' + cy, where (x', y') is (x/z, y/z) as the lens distorts it.
struct CameraIntrinsics {
  int width = 0;
  int height = 0;
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  LensDistortion distortion{};
};

/// Continuous-time densities, bias instabilities and one-sigma turn-on biases, from the IMU's data sheet.
struct ImuNoise {
  double gyro_density = 2.4e-4;        ///< [rad/s/sqrt(Hz)]
  double accel_density = 1.5e-3;       ///< [m/s^2/sqrt(Hz)]
  double gyro_random_walk = 2.0e-5;    ///< [rad/s^2/sqrt(Hz)]
  double accel_random_walk = 1.0e-3;   ///< [m/s^3/sqrt(Hz)]
  double gyro_turn_on_sigma = 8.7e-3;  ///< [rad/s]
  double accel_turn_on_sigma = 0.2;    ///< [m/s^2]
  /// Flicker noise; the Allan deviation's floor is 0.664 times this.
  double gyro_bias_instability = 0.0;   ///< [rad/s]
  double accel_bias_instability = 0.0;  ///< [m/s^2]
};

/// Variance of a pixel in 8-bit counts (DN): read_noise_dn^2 + DN / electrons_per_dn, plus 1/12 of rounding.
struct CameraNoise {
  double electrons_per_dn = 85.0;
  double read_noise_dn = 0.34;
};

/// A camera besides the main one: its frames, grey or of depth, carry its id.
struct FurtherCamera {
  int camera_id = 1;
  Pose body_from_camera;
  CameraIntrinsics intrinsics;
  double rate_hz = 50.0;
};

/// A box that holds a part of what carries the sensors, as a robot's description has it.
struct OwnPart {
  Pose body_from_part;  ///< the box's middle, and its axes
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// What an estimator is told about its sensors: extrinsics, intrinsics, data-sheet noise and what of their carrier may
/// be in view, nothing else.
struct Calibration {
  double imu_rate_hz = 200.0;
  ImuNoise imu;

  bool has_camera = true;
  Pose body_from_camera;  ///< point_in_body = body_from_camera * point_in_camera
  CameraIntrinsics camera;
  CameraNoise camera_noise;
  double camera_rate_hz = 50.0;
  std::vector<FurtherCamera> further_cameras;  ///< the one above is camera 0

  bool has_lidar = true;
  Pose body_from_lidar;  ///< point_in_body = body_from_lidar * point_in_lidar
  int lidar_rings = 16;
  double lidar_rate_hz = 10.0;
  double lidar_range_sigma_m = 0.015;
  double lidar_min_range_m = 0.5;
  double lidar_max_range_m = 100.0;
  std::vector<OwnPart> own_body;  ///< returns from within these boxes are not of the world
};

}  // namespace plumbline
