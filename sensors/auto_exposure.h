#pragma once

#include <array>
#include <string>

#include "sensors/sensor_chip.h"

namespace plumbline {

/// What a camera's automatic exposure may do.
struct ExposureControl {
  double min_exposure_s = 50e-6;
  double max_exposure_s = 8e-3;
  double row_time_s = 0.0;   ///< exposures are whole multiples of it; 0: of any length
  double max_gain = 4.0;     ///< analogue, after the exposure is exhausted
  double gain_step = 0.0;    ///< gains are 1 plus multiples of it; 0: any
  double target_dn = 100.0;  ///< mean grey value above black that it aims at
};

/// @throws std::invalid_argument "OWNER: rule" naming the field that is out of range.
void validate_or_throw(const ExposureControl& control, const std::string& owner);

/// Steers the mean grey value towards the target, half of the way in stops at every frame. What one frame shows acts on
/// the frame after the next, as on the MT9V03x, whose registers take that long. Exposure time goes first, since light
/// costs nothing else, gain last.
class AutoExposure {
 public:
  /// Starts at 2 ms, or the limit that is nearer to it.
  explicit AutoExposure(const ExposureControl& control);

  /// Of the next frame.
  const ExposureSettings& next() const { return queue_.front(); }
  /// The mean grey value above black of the frame taken with next(); moves on to the frame after it.
  void observe(double signal_dn);

 private:
  ExposureSettings settings_for(double exposure_times_gain_s) const;

  ExposureControl control_;
  std::array<ExposureSettings, 2> queue_;  ///< of the next frame and the one after it
};

}  // namespace plumbline
