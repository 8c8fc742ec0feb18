#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sensors/imu_model.h"

namespace plumbline {

/// Vibration as a sum of tones with random phases, one in each slice of the band: its mean over a sample's interval is
/// exact, so what lies above half the sample rate folds down as in a real unit that averages.
class Vibration {
 public:
  Vibration(const VibrationModel& model, std::uint64_t seed);

  bool is_still() const { return model_.rms_mps2 == 0.0 && model_.rms_per_speed == 0.0; }

  /// Mean acceleration over an interval, in B [m/s^2].
  Eigen::Vector3d mean(std::int64_t start_ns, std::int64_t end_ns, double speed_mps) const;

 private:
  struct Tone {
    double angular_frequency = 0.0;  ///< [rad/s]
    double phase = 0.0;
  };
  static constexpr std::size_t kTones = 12;

  VibrationModel model_;
  std::array<std::array<Tone, kTones>, 3> tones_;  ///< per axis
};

}  // namespace plumbline
