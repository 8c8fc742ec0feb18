#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/pose.h"

namespace plumbline {

/// The true motion at one time.
struct MotionState {
  Pose world_from_body;
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();             ///< [m/s]
  Eigen::Vector3d acceleration_in_world = Eigen::Vector3d::Zero();         ///< [m/s^2], without gravity
  Eigen::Vector3d angular_rate_in_body = Eigen::Vector3d::Zero();          ///< [rad/s]
  Eigen::Vector3d angular_acceleration_in_body = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// A twice continuously differentiable motion: natural cubic splines through stamped poses, positions and (normalised)
/// quaternion components alike. Before the first and after the last pose the motion rests there.
class Trajectory {
 public:
  /// @throws std::invalid_argument for fewer than four poses or stamps that do not increase.
  explicit Trajectory(const std::vector<PoseTrack::Stamped>& poses);

  /// A motion that is not known to its end: the uniform cubic B-spline of control poses `step_ns` apart, at rest at
  /// `first` until `start_ns`, and from then on as it is extended. What is known of it never changes.
  Trajectory(const Pose& first, std::int64_t start_ns, std::int64_t step_ns);
  /// The next control pose. The last knot, and with it end_ns(), follows a step behind it. Nobody may read meanwhile.
  void extend(const Pose& control);

  /// A motion that is under way at time 0 starts before it.
  std::int64_t start_ns() const { return start_ns_; }
  std::int64_t end_ns() const { return end_ns_; }
  /// The mean distance between knots, rounded to whole milliseconds and at least one.
  std::int64_t knot_ns() const;
  /// The first knot after a time, beyond which the acceleration goes on with another slope; infinity after the last.
  double knot_after_s(double time_s) const;
  MotionState at(std::int64_t stamp_ns) const { return at_seconds(static_cast<double>(stamp_ns) * 1e-9); }
  MotionState at_seconds(double time_s) const;
  Pose pose(std::int64_t stamp_ns) const { return at(stamp_ns).world_from_body; }

 private:
  using Channels = Eigen::Matrix<double, 7, 1>;
  void push_knot(const Channels& before, const Channels& at, const Channels& after);

  std::int64_t start_ns_ = 0;
  std::int64_t end_ns_ = 0;
  std::int64_t step_ns_ = 0;  // between the control poses of a motion that grows
  Channels controls_[2];      // its last two, the newest last
  std::vector<double> times_s_;
  std::vector<Channels> values_;  // x y z, qx qy qz qw
  std::vector<Channels> second_;  // second derivatives at the knots
};

}  // namespace plumbline
