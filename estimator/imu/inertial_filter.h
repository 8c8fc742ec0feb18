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

/// The map that scans are matched with was made of earlier scans at poses that erred, too. A match tells where the body
/// is in that map, so it carries the map's error, which changes only as the map's content is renewed. Taken for an
/// absolute fix scan by scan, ten a second, it would soon hold the attitude so firmly that gravity could not correct
/// it.
///
/// Errors are those of a left perturbation, seen from the world's origin: R = exp(a) R^, p = exp(a) p^ + b,
/// v = exp(a) v^ + c (the right-invariant error of Barrau and Bonnabel, "The invariant extended Kalman filter as a
/// stable observer", 2017). What no sensor can tell, where the world lies and which way it is turned, is then the same
/// direction of the error state whatever the state is. With errors in the body's axes it moves with the estimate, and
/// every correction makes the filter surer of a heading and a place that nothing has shown.
///
/// Error state: [attitude, position, velocity, gyro bias, accel bias, gravity's x and y in W, the map's offset
/// (attitude and position), key-frame attitude and position, the pose some time ago: attitude and position].
class InertialFilter {
 public:
  static constexpr int kAttitude = 0;
  static constexpr int kPosition = 3;
  static constexpr int kVelocity = 6;
  static constexpr int kGyroBias = 9;
  static constexpr int kAccelBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kMap = 17;
  static constexpr int kKeyframe = 23;
  static constexpr int kPast = 29;
  static constexpr int kSize = 35;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using ErrorState = Eigen::Matrix<double, kSize, 1>;

  /// @param remapping  false: a module's solution counts in all directions alike, however little its data say of one
  InertialFilter(const InitialState& start, const ImuNoise& noise, bool remapping);

  /// Mechanises over a segment that starts at the state's stamp, and spreads the covariance.
  void predict(const InertialSegment& segment);

  /// Fuses a pose solved against the map. `predicted` is what map_from_body() was at the measurement's time.
  /// @param inflation  of the solution's covariance, for errors that its rows share
  void update_pose(const SolveResult& map_from_body, const Pose& predicted, double inflation);
  /// A scan has been merged into the map at the present pose.
  /// @param share       of what the next scans will be matched with that is new, [0, 1]
  /// @param systematic  covariance of errors that all matches with one content share, right perturbation
  void renew_map(double share, const Matrix6d& systematic);
  /// Fuses a pose solved against the key-frame.
  void update_keyframe_motion(const SolveResult& keyframe_from_body, const Pose& predicted, double inflation);

  /// Makes the pose at the newest image the key-frame.
  void set_keyframe(const Pose& world_from_body);
  /// Makes the present pose the past one, for the covariance of the motion since.
  void set_past();

  const NavigationState& state() const { return state_; }
  const Pose& world_from_keyframe() const { return world_from_keyframe_; }
  const Covariance& covariance() const { return covariance_; }
  /// Of world_from_body, right perturbation; so are all others that are given out or taken.
  Matrix6d pose_covariance() const;
  /// Where the body stands in the map, whose content may be off by what it took over from earlier poses.
  Pose map_from_body() const { return map_from_world_ * state_.world_from_body; }
  Matrix6d map_from_body_covariance() const;
  /// Of keyframe_from_body, right perturbation.
  Matrix6d keyframe_motion_covariance() const;
  /// Of past_from_body, right perturbation.
  Matrix6d past_motion_covariance() const;

 private:
  using Jacobian = Eigen::Matrix<double, 6, kSize>;
  Jacobian map_jacobian() const;
  Jacobian motion_jacobian(int clone) const;
  void clone_pose(int clone);
  /// @param shared  covariance of what all rows err by alike, right perturbation of the solved pose
  void update(const SolveResult& solved, const Pose& predicted, const Jacobian& d_pose_d_error, double inflation,
              const Matrix6d& shared);
  void apply(const ErrorState& correction);
  void symmetrize();

  NavigationState state_;
  Pose world_from_keyframe_;
  Pose world_from_past_;
  Pose map_from_world_;
  ImuNoise noise_;
  bool remapping_ = true;
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace plumbline
