#include "estimator/imu/initialization.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {
constexpr double kRestWindow_s = 1.0;  // averages a consumer gyro's bias to 0.02 deg/s
constexpr double kDecisionWindow_s = 0.1;
constexpr double kMovingFactor = 5.0;    // spread above so many times the data sheet's noise is motion
constexpr double kMaxRestRate = 0.1;     // [rad/s], far above any turn-on bias at rest
constexpr double kMovingTilt = 0.1;      // [rad], while walking the mean force is off the vertical by about this
constexpr double kRestSigma = 1e-4;      // [rad, m] a sample
constexpr double kDensityMargin = 2.0;   // of a single sample: rounding to the unit's steps adds to its noise
constexpr double kMovingVelocity = 5.0;  // [m/s]
}  // namespace

Initializer::Initializer(const Calibration& calibration) : noise_(calibration.imu), rate_hz_(calibration.imu_rate_hz) {}

std::optional<InitialState> Initializer::add(const ImuSample& sample) {
  ++count_;
  const Eigen::Vector3d rate_step = sample.angular_rate - mean_rate_;
  const Eigen::Vector3d force_step = sample.specific_force - mean_force_;
  mean_rate_ += rate_step / count_;
  mean_force_ += force_step / count_;
  rate_square_sum_ += rate_step.cwiseProduct(sample.angular_rate - mean_rate_);
  force_square_sum_ += force_step.cwiseProduct(sample.specific_force - mean_force_);

  const double elapsed = count_ / rate_hz_;
  if (elapsed < kDecisionWindow_s) return std::nullopt;
  const bool in_motion = moving();
  if (!in_motion && elapsed < kRestWindow_s) return std::nullopt;

  InitialState start;
  start.state.stamp_ns = sample.stamp_ns;
  start.state.world_from_body = attitude();
  if (in_motion) {
    start.tilt_sigma = kMovingTilt;
    start.gyro_bias_sigma = noise_.gyro_turn_on_sigma;
    start.velocity_sigma = kMovingVelocity;
  } else {
    start.state.gyro_bias = mean_rate_;
    // Only the length of the mean force is known to be gravity's; its direction is shared with the attitude.
    start.state.accel_bias = mean_force_ * (1.0 - kStandardGravity / mean_force_.norm());
    start.tilt_sigma = noise_.accel_density / std::sqrt(elapsed) / kStandardGravity;
    start.gyro_bias_sigma = noise_.gyro_density / std::sqrt(elapsed);
    start.velocity_sigma = 0.01;
  }
  return start;
}

bool Initializer::moving() const {
  const double n = count_;
  const double rate_limit = kMovingFactor * noise_.gyro_density * std::sqrt(rate_hz_);
  const double force_limit = kMovingFactor * noise_.accel_density * std::sqrt(rate_hz_);
  return mean_rate_.norm() > kMaxRestRate || std::sqrt(rate_square_sum_.maxCoeff() / n) > rate_limit ||
         std::sqrt(force_square_sum_.maxCoeff() / n) > force_limit;
}

Matrix6d Initializer::increment_covariance() const {
  const double sample_sigma = kDensityMargin * noise_.accel_density * std::sqrt(rate_hz_) / kStandardGravity;
  const double n = std::max(2, count_);
  Vector6d variance = Vector6d::Constant(kRestSigma * kRestSigma);
  variance.head<2>().array() += sample_sigma * sample_sigma / (n * (n - 1.0));
  return variance.asDiagonal();
}

Pose Initializer::attitude() const {
  if (mean_force_.norm() < 1e-3) return {};
  const Eigen::Vector3d up = mean_force_.normalized();
  const double roll = std::atan2(up.y(), up.z());
  const double pitch = std::atan2(-up.x(), std::hypot(up.y(), up.z()));
  return {rotation_from_rpy({roll, pitch, 0.0}), Eigen::Vector3d::Zero()};
}

}  // namespace plumbline
