#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "estimator/messages.h"
#include "sensors/imu_model.h"
#include "sensors/imu_noise.h"
#include "sensors/imu_vibration.h"
#include "sim/trajectory.h"

namespace plumbline {

/// An inertial unit on the body. A sample is the mean over its interval of the exact motion and the vibration where the
/// unit sits; then, in this order: gain and misalignment, sensitivity of the gyros to force, biases and noise,
/// clipping, rounding to the output's step.
class Imu {
 public:
  /// @param seed  the scenario's; every effect draws from its own stream, so that switching one off changes no other
  Imu(ImuModel model, std::uint64_t seed);

  /// The sample for the interval [stamp_ns - period, stamp_ns]. Samples must be asked for in order.
  ImuSample sample(const Trajectory& trajectory, std::int64_t stamp_ns);

  /// What the unit makes of a true sample. Samples must come in order.
  ImuSample measured(const ImuSample& truth);

  std::int64_t period_ns() const;
  const ImuModel& model() const { return model_; }
  /// False makes an ideal unit.
  bool noise_enabled = true;

 private:
  ImuModel model_;
  Vibration vibration_;
  Eigen::Matrix3d gyro_gain_;
  Eigen::Matrix3d accel_gain_;
  Eigen::Matrix3d rate_from_force_;  ///< [rad/s per m/s^2]
  Eigen::Vector3d gyro_turn_on_;
  Eigen::Vector3d accel_turn_on_;
  TriadNoise gyro_noise_;
  TriadNoise accel_noise_;
};

/// What acts on each axis's readings of the model's random errors.
NoiseFigures gyro_figures(const ImuModel& model);
NoiseFigures accel_figures(const ImuModel& model);

/// Mean specific force and angular rate over an interval at a point of the body, in B, by Gauss-Legendre quadrature
/// between the trajectory's knots, across which it is not smooth.
/// Off the body's origin the force holds the Euler and the centripetal acceleration.
ImuSample exact_sample(const Trajectory& trajectory, std::int64_t start_ns, std::int64_t end_ns,
                       const Eigen::Vector3d& position_in_body = Eigen::Vector3d::Zero());

}  // namespace plumbline
