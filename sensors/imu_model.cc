#include "sensors/imu_model.h"

#include <cmath>
#include <stdexcept>

namespace plumbline {
namespace {

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

bool is_amount(double value) { return std::isfinite(value) && value >= 0.0; }

void validate(const TriadErrors& errors) {
  require(is_amount(errors.scale_sigma) && errors.scale_sigma < 0.5, "imu: scale_sigma must be in [0, 0.5)");
  require(is_amount(errors.misalignment_sigma_rad) && errors.misalignment_sigma_rad < 0.5,
          "imu: misalignment_sigma_rad must be in [0, 0.5)");
  require(is_amount(errors.range), "imu: range must be finite and not negative");
  require(is_amount(errors.resolution), "imu: resolution must be finite and not negative");
}

}  // namespace

void validate_or_throw(const ImuModel& model) {
  require(model.rate_hz >= 10.0 && model.rate_hz <= 2000.0, "imu: rate_hz must be in [10, 2000]");
  const ImuNoise& n = model.noise;
  for (const double v : {n.gyro_density, n.accel_density, n.gyro_bias_instability, n.accel_bias_instability,
                         n.gyro_random_walk, n.accel_random_walk, n.gyro_turn_on_sigma, n.accel_turn_on_sigma}) {
    require(is_amount(v), "imu: every noise figure must be finite and not negative");
  }
  validate(model.gyro);
  validate(model.accel);
  require(is_amount(model.g_sensitivity_sigma), "imu: g_sensitivity_sigma must be finite and not negative");
  require(model.position_in_body.allFinite(), "imu: position_in_body must be finite");
  const VibrationModel& v = model.vibration;
  require(is_amount(v.rms_mps2) && is_amount(v.rms_per_speed), "imu: vibration must be finite and not negative");
  require(v.low_hz > 0.0 && v.high_hz > v.low_hz && v.high_hz <= 1e4,
          "imu: the vibration's band must be 0 < low_hz < high_hz <= 10000");
}

}  // namespace plumbline
