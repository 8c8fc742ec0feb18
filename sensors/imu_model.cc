#include "sensors/imu_model.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

void require_of_imu(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("imu: ") + message);
}

bool is_amount(double value) { return std::isfinite(value) && value >= 0.0; }

void validate(const TriadErrors& errors) {
  require_of_imu(is_amount(errors.scale_sigma) && errors.scale_sigma < 0.5, "scale_sigma must be in [0, 0.5)");
  require_of_imu(is_amount(errors.misalignment_sigma_rad) && errors.misalignment_sigma_rad < 0.5,
                 "misalignment_sigma_rad must be in [0, 0.5)");
  require_of_imu(is_amount(errors.range), "range must be finite and not negative");
  require_of_imu(is_amount(errors.resolution), "resolution must be finite and not negative");
}

}  // namespace

void validate_or_throw(const ImuModel& model) {
  require_of_imu(model.rate_hz >= 10.0 && model.rate_hz <= 2000.0, "rate_hz must be in [10, 2000]");
  const ImuNoise& n = model.noise;
  for (const double v : {n.gyro_density, n.accel_density, n.gyro_bias_instability, n.accel_bias_instability,
                         n.gyro_random_walk, n.accel_random_walk, n.gyro_turn_on_sigma, n.accel_turn_on_sigma}) {
    require_of_imu(is_amount(v), "every noise figure must be finite and not negative");
  }
  validate(model.gyro);
  validate(model.accel);
  require_of_imu(is_amount(model.g_sensitivity_sigma), "g_sensitivity_sigma must be finite and not negative");
  require_of_imu(model.position_in_body.allFinite(), "position_in_body must be finite");
  const VibrationModel& v = model.vibration;
  require_of_imu(is_amount(v.rms_mps2) && is_amount(v.rms_per_speed), "vibration must be finite and not negative");
  require_of_imu(v.low_hz > 0.0 && v.high_hz > v.low_hz && v.high_hz <= 1e4,
                 "the vibration's band must be 0 < low_hz < high_hz <= 10000");
}

}  // namespace plumbline
