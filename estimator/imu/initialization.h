#pragma once

#include <optional>

#include "estimator/imu/mechanization.h"
#include "estimator/messages.h"

namespace plumbline {

/// What the first samples tell: attitude against gravity, gyro bias if at rest, and how sure that is.
struct InitialState {
  NavigationState state;
  double tilt_sigma = 0.0;       ///< [rad], given a perfect accelerometer
  double gyro_bias_sigma = 0.0;  ///< [rad/s]
  double velocity_sigma = 0.0;   ///< [m/s]
};

/// Watches the first samples. At rest it averages for a while; in motion it starts at once and says how unsure it is.
class Initializer {
 public:
  explicit Initializer(const Calibration& calibration);

  /// Empty until enough is known.
  std::optional<InitialState> add(const ImuSample& sample);
  /// Level attitude by what has been seen so far, at the origin; for outputs before the start.
  Pose attitude() const;
  /// Of the attitude's change with the last sample: by how much its variance fell. What is taken to rest is held to do
  /// so within a millimetre and a tenth of a milliradian a sample.
  Matrix6d increment_covariance() const;

 private:
  bool moving() const;

  ImuNoise noise_;
  double rate_hz_;
  int count_ = 0;
  Eigen::Vector3d mean_rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_square_sum_ = Eigen::Vector3d::Zero();  ///< of deviations from the running mean
  Eigen::Vector3d force_square_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace plumbline
