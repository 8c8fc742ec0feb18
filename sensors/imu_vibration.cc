#include "sensors/imu_vibration.h"

#include <cmath>
#include <numbers>

#include "sim/random_stream.h"

namespace plumbline {

Vibration::Vibration(const VibrationModel& model, std::uint64_t seed) : model_(model) {
  RandomStream stream(seed, "imu.vibration");
  const double slice_hz = (model.high_hz - model.low_hz) / kTones;
  for (auto& axis : tones_) {
    double low_hz = model.low_hz;
    for (Tone& tone : axis) {
      tone.angular_frequency = 2.0 * std::numbers::pi * (low_hz + slice_hz * stream.uniform());
      tone.phase = stream.uniform(0.0, 2.0 * std::numbers::pi);
      low_hz += slice_hz;
    }
  }
}

Eigen::Vector3d Vibration::mean(std::int64_t start_ns, std::int64_t end_ns, double speed_mps) const {
  const double middle_s = 0.5e-9 * static_cast<double>(start_ns + end_ns);
  const double half_s = 0.5e-9 * static_cast<double>(end_ns - start_ns);
  // A tone of amplitude a has the mean square a^2 / 2.
  const double amplitude = (model_.rms_mps2 + model_.rms_per_speed * speed_mps) * std::sqrt(2.0 / kTones);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (const Tone& tone : tones_.at(static_cast<std::size_t>(axis))) {
      const double half_angle = tone.angular_frequency * half_s;
      sum[axis] += std::sin(half_angle) / half_angle * std::sin(tone.angular_frequency * middle_s + tone.phase);
    }
  }
  return amplitude * sum;
}

}  // namespace plumbline
