#pragma once

#include <Eigen/Core>

#include "estimator/imu/initialization.h"
#include "estimator/imu/mechanization.h"
#include "estimator/solver/robust_solver.h"

/// Feedback from vision and scan matching to the IMU (thesis 5.23-5.27) in its recursive form: an error-state filter
/// that carries the mechanised state, its biases, the direction of gravity in the world and a copy of the key-frame's
/// pose. A module's solution enters only along the directions that its data determined, so along the others the IMU's
/// own prediction and the old biases persist; position never overwrites velocity, it informs it by covariance.
namespace plumbline {

/// Error state: [attitude, position (both right perturbations in B), velocity in W, gyro bias, accel bias,
/// gravity's x and y in W, key-frame attitude, key-frame position].
class InertialFilter {
 public:
  static constexpr int kAttitude = 0;
  static constexpr int kPosition = 3;
  static constexpr int kVelocity = 6;
  static constexpr int kGyroBias = 9;
  static constexpr int kAccelBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kKeyframe = 17;
  static constexpr int kSize = 23;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using ErrorState = Eigen::Matrix<double, kSize, 1>;

  /// @param remapping  false: a module's solution counts in all directions alike, however little its data say of one
  InertialFilter(const InitialState& start, const ImuNoise& noise, bool remapping);

  /// Mechanises over a segment that starts at the state's stamp, and spreads the covariance.
  void predict(const InertialSegment& segment);

  /// Fuses a pose solved against the map. `predicted` is the pose that the state had at the measurement's time.
  /// @param inflation  of the solution's covariance, for errors that its rows share
  void update_pose(const SolveResult& world_from_body, const Pose& predicted, double inflation);
  /// Fuses a pose solved against the key-frame.
  void update_keyframe_motion(const SolveResult& keyframe_from_body, const Pose& predicted, double inflation);

  /// Makes the pose at the newest image the key-frame.
  void set_keyframe(const Pose& world_from_body);

  const NavigationState& state() const { return state_; }
  const Pose& world_from_keyframe() const { return world_from_keyframe_; }
  const Covariance& covariance() const { return covariance_; }
  Matrix6d pose_covariance() const { return covariance_.topLeftCorner<6, 6>(); }
  /// Of keyframe_from_body, right perturbation.
  Matrix6d keyframe_motion_covariance() const;

 private:
  using Jacobian = Eigen::Matrix<double, 6, kSize>;
  Jacobian keyframe_motion_jacobian() const;
  void update(const SolveResult& solved, const Pose& predicted, const Jacobian& d_pose_d_error, double inflation);
  void apply(const ErrorState& correction);
  void symmetrize();

  NavigationState state_;
  Pose world_from_keyframe_;
  ImuNoise noise_;
  bool remapping_ = true;
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace plumbline
