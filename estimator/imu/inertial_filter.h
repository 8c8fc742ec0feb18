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
/// The state is kept as the body sees it: velocity and gravity in B, and the body's pose in each of the frames that
/// something is measured in (the map, the key-frame) as well as in the world. All poses go through the same motion, so
/// that their errors grow together, and a measurement is one of them: the world's frame takes part in none. With a
/// velocity in the world and copies of world poses, what no sensor can tell (where the world lies and which way it is
/// turned) is a direction of the error state that moves with the estimate, and every correction makes the filter surer
/// of a heading and a place that nothing has shown (Huang, Mourikis and Roumeliotis, "Observability-based rules for
/// designing consistent EKF SLAM estimators", 2010).
///
/// Error state: [world_from_body (attitude, position), velocity in B, gyro bias, accel bias, gravity in B, then as the
/// first map_from_body, keyframe_from_body and past_from_body]; perturbations of poses are on the right.
class InertialFilter {
 public:
  static constexpr int kWorld = 0;
  static constexpr int kVelocity = 6;
  static constexpr int kGyroBias = 9;
  static constexpr int kAccelBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kMap = 18;
  static constexpr int kKeyframe = 24;
  static constexpr int kPast = 30;
  static constexpr int kSize = 36;
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
  void set_keyframe(const Pose& world_from_keyframe);
  /// Makes the present pose the past one, for the covariance of the motion since.
  void set_past();

  const NavigationState& state() const { return state_; }
  Pose world_from_keyframe() const { return state_.world_from_body * keyframe_from_body_.inverse(); }
  const Covariance& covariance() const { return covariance_; }
  Matrix6d pose_covariance() const { return covariance_of(kWorld); }
  /// Where the body stands in the map, whose content may be off by what it took over from earlier poses.
  const Pose& map_from_body() const { return map_from_body_; }
  Matrix6d map_from_body_covariance() const { return covariance_of(kMap); }
  /// Of keyframe_from_body, right perturbation.
  Matrix6d keyframe_motion_covariance() const { return covariance_of(kKeyframe); }
  /// Of past_from_body, right perturbation.
  Matrix6d past_motion_covariance() const { return covariance_of(kPast); }
  /// By which corrections have lately moved map and body together in the world, right perturbation of world_from_body;
  /// what lies back longer than kRevisionMemory_s fades. Bias and tilt that a turn brings to light have bent the way
  /// for long, and all of that is put right at once.
  const Vector6d& map_revision() const { return map_revision_; }

 private:
  Matrix6d covariance_of(int pose) const { return covariance_.block<6, 6>(pose, pose); }
  /// A frame of the body's own: the pose in it is certain.
  void start_frame(int pose);
  /// @param pose    which of the error state's poses was measured
  /// @param shared  covariance of what all rows err by alike, right perturbation of the solved pose
  void update(const SolveResult& solved, const Pose& predicted, int pose, double inflation, const Matrix6d& shared);
  void apply(const ErrorState& correction);
  void symmetrize();

  NavigationState state_;
  Pose map_from_body_;
  Pose keyframe_from_body_;
  ImuNoise noise_;
  bool remapping_ = true;
  Covariance covariance_ = Covariance::Zero();
  Vector6d map_revision_ = Vector6d::Zero();
};

}  // namespace plumbline
