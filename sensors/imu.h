#pragma once

#include <cstdint>
#include <string>

#include "estimator/messages.h"
#include "sim/random_stream.h"
#include "sim/trajectory.h"

namespace plumbline {

/// An inertial unit at the body's origin.
struct ImuModel {
  std::string name = "bmi055";
  double rate_hz = 200.0;
  ImuNoise noise;  ///< BMI055: 0.014 deg/s/sqrt(Hz), 150 ug/sqrt(Hz); turn-on 0.5 deg/s, 0.2 m/s^2
};

void validate_or_throw(const ImuModel& model);

/// Samples are means over their interval, of the exact motion, plus turn-on bias, bias random walk and white noise.
class Imu {
 public:
  Imu(ImuModel model, std::uint64_t seed);

  /// The sample for the interval [stamp_ns - period, stamp_ns]. Samples must be asked for in order.
  ImuSample sample(const Trajectory& trajectory, std::int64_t stamp_ns);

  std::int64_t period_ns() const;
  const ImuModel& model() const { return model_; }
  bool noise_enabled = true;

 private:
  ImuModel model_;
  RandomStream stream_;
  Eigen::Vector3d gyro_bias_;
  Eigen::Vector3d accel_bias_;
};

/// Mean specific force and angular rate of a motion over an interval, in B, by Gauss-Legendre quadrature.
ImuSample exact_sample(const Trajectory& trajectory, std::int64_t start_ns, std::int64_t end_ns);

}  // namespace plumbline
