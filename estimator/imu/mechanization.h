#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "estimator/geometry/pose.h"
#include "estimator/messages.h"

namespace plumbline {

inline constexpr double kStandardGravity = 9.81;  ///< [m/s^2]

/// Position, attitude and velocity of the body in the world, and what corrects the IMU.
struct NavigationState {
  std::int64_t stamp_ns = 0;
  Pose world_from_body;
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_in_world{0.0, 0.0, -kStandardGravity};
};

/// An IMU's reading over an interval, as a straight line in time: mean and slope of rate and force, both in B.
struct InertialSegment {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();         ///< mean [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();        ///< mean [m/s^2]
  Eigen::Vector3d rate_slope = Eigen::Vector3d::Zero();   ///< [rad/s^2]
  Eigen::Vector3d force_slope = Eigen::Vector3d::Zero();  ///< [m/s^3]

  /// The same line over a part of the interval.
  InertialSegment part(std::int64_t from_ns, std::int64_t to_ns) const;
};

/// Over a longer gap the line between two samples is worth nothing.
inline constexpr std::int64_t kMaxImuGap_ns = 500'000'000;

/// The segment from one sample to the next; the slope is the difference of neighbouring means.
InertialSegment segment_between(const ImuSample& previous, const ImuSample& sample);

/// Integrates rate and force over a segment (thesis 5.3-5.4 solved for motion). Rotation and velocity carry the coning
/// and sculling terms of a linear reading (Savage, J. Guidance 21(1), 1998), so the error falls with a high power of
/// the interval.
NavigationState mechanize(const NavigationState& state, const InertialSegment& segment);

}  // namespace plumbline
