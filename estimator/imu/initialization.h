#pragma once

#include <optional>
#include <vector>

#include "estimator/imu/mechanization.h"
#include "estimator/messages.h"

namespace plumbline {

/// What corrections have moved the past by stays in the covariance of increments for so long.
inline constexpr double kRevisionMemory_s = 1.0;

/// What the first samples tell: attitude against gravity, gyro bias unless travelling, and how sure that is.
struct InitialState {
  NavigationState state;
  double tilt_sigma = 0.0;                                         ///< [rad], given a perfect accelerometer
  Eigen::Matrix3d gyro_bias_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2/s^2]
  double velocity_sigma = 0.0;                                     ///< [m/s]
  /// The samples before the start were integrated with the bias as it is known now, and so the attitude errs with it:
  /// d attitude (right perturbation) d bias [s].
  Eigen::Matrix3d d_attitude_d_gyro_bias = Eigen::Matrix3d::Zero();
};

/// Watches the first samples, and judges by how far the readings, integrated, stray from their mean's line:
/// - at rest, but for what a hand or an idle engine does: a second is averaged, and the straying says how much of the
///   mean may be motion;
/// - steady, as a vehicle at constant speed is: the same, but the velocity is unknown, and a mean rate about the
/// vertical
///   beyond such units' biases is a turn. A body at rest that is knocked strays as far; it has been still as no vehicle
///   under way is, to the noise of the readings, before or after;
/// - manoeuvring: it starts at once, with the data sheet's turn-on figures.
class Initializer {
 public:
  explicit Initializer(const Calibration& calibration);

  /// Empty until enough is known. The world's x axis is the heading of the first sample.
  std::optional<InitialState> add(const ImuSample& sample);
  /// By what has been seen so far, at the origin, as a start at rest now would have it: for outputs before the start,
  /// which go over into the state without a step.
  const Pose& attitude() const { return attitude_; }
  /// Of the attitude's change with the last sample. What is taken to rest is held to do so within a millimetre and a
  /// tenth of a milliradian a sample; by as much as newer samples have moved the attitude, older outputs were wrong.
  Matrix6d increment_covariance() const;

 private:
  /// How far the body strayed while watched: of the integrated deviations from the mean, the longest axis.
  struct Excursion {
    double angle = 0.0;     ///< [rad]
    double velocity = 0.0;  ///< [m/s]
  };
  Excursion excursion() const;
  bool has_been_still() const;
  bool turns_no_more_than_noise(const Excursion& strayed) const;
  double hidden_share(const Excursion& strayed) const;
  bool manoeuvring(const Excursion& excursion) const;
  InitialState calm_start(const Excursion& strayed) const;
  void find_gyro_bias(const Excursion& strayed, bool at_rest, InitialState& start) const;
  void set_attitude(InitialState& start) const;
  Pose attitude_now(const Eigen::Vector3d& gyro_bias) const;
  void settle(const Excursion& strayed);

  ImuNoise noise_;
  double rate_hz_;
  std::vector<ImuSample> samples_;
  Eigen::Vector3d mean_rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_force_ = Eigen::Vector3d::Zero();
  Pose attitude_;
  Eigen::Vector3d revision_ = Eigen::Vector3d::Zero();  ///< [rad] of the attitude within the last second, in B
};

}  // namespace plumbline
