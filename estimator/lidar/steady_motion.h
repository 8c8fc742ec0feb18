#pragma once

#include "estimator/imu/mechanization.h"

namespace plumbline {

/// Prediction without inertial readings: the body goes on turning and moving as it last did, in its own frame.
class SteadyMotion {
 public:
  /// @param turns  false: attitude is not predicted but read from the segments' rates
  SteadyMotion(const NavigationState& start, bool turns) : state_(start), turns_(turns) {}

  void predict(const InertialSegment& segment);
  /// The pose is corrected, and the motion that led to it from an earlier pose goes on.
  void follow(const Pose& world_from_body, const Pose& earlier_from_body, double duration_s);
  void move(const Pose& world_from_body);
  /// Where that motion leads from a pose. @param read  the pose then as predicted before: gives attitude that is read
  Pose onwards(const Pose& world_from_body, double duration_s, const Pose& read) const;

  const NavigationState& state() const { return state_; }  ///< its velocity too
  /// Of a motion over a time: what rate and velocity may have changed since they were measured.
  Matrix6d motion_covariance(double duration_s) const;
  /// Of the pose at the end of a motion that was taken for steady and was not, by how much rate and velocity have
  /// lately changed from one motion to the next.
  Matrix6d bend_covariance() const;

 private:
  NavigationState state_;
  Eigen::Vector3d velocity_in_body_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  bool turns_;
  bool known_ = false;
  double duration_s_ = 0.0;              ///< of the last motion followed
  int changes_ = 0;                      ///< seen so far
  double rate_change_square_ = 0.0;      ///< mean square of an axis [rad^2/s^2]
  double velocity_change_square_ = 0.0;  ///< likewise [m^2/s^2]
};

}  // namespace plumbline
