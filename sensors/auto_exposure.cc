#include "sensors/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr double kDamping = 0.5;
constexpr double kDimmest_dn = 0.5;  // darkness has no ratio to the target

/// Whole multiples of a step that lie within limits; 1e-9 of a step for rounding.
double to_step(double value, double step, double min, double max) {
  if (step <= 0.0) return std::clamp(value, min, max);
  const double least = std::ceil(min / step - 1e-9);
  const double most = std::max(least, std::floor(max / step + 1e-9));
  return step * std::clamp(std::round(value / step), least, most);
}

}  // namespace

void validate_or_throw(const ExposureControl& control, const std::string& owner) {
  const auto require = [&owner](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(owner + ": " + rule);
  };
  require(control.min_exposure_s > 0.0, "min_exposure_s must be positive");
  require(control.max_exposure_s >= control.min_exposure_s, "max_exposure_s must be at least min_exposure_s");
  require(control.row_time_s >= 0.0, "row_time_s must not be negative");
  require(control.row_time_s <= control.max_exposure_s, "max_exposure_s must be at least row_time_s");
  require(control.max_gain >= 1.0, "max_gain must be at least 1");
  require(control.gain_step >= 0.0, "gain_step must not be negative");
  require(control.target_dn > 0.0 && control.target_dn < 255.0, "target_dn must be within (0, 255)");
}

AutoExposure::AutoExposure(const ExposureControl& control) : control_(control) {
  ExposureSettings first;
  first.exposure_s = to_step(first.exposure_s, control.row_time_s, control.min_exposure_s, control.max_exposure_s);
  queue_.fill(first);
}

void AutoExposure::observe(double signal_dn) {
  const double correction = std::pow(control_.target_dn / std::max(signal_dn, kDimmest_dn), kDamping);
  const ExposureSettings& used = queue_.front();
  const ExposureSettings wanted = settings_for(used.exposure_s * used.gain * correction);
  queue_ = {queue_.back(), wanted};
}

ExposureSettings AutoExposure::settings_for(double exposure_times_gain_s) const {
  ExposureSettings settings;
  settings.exposure_s =
      to_step(exposure_times_gain_s, control_.row_time_s, control_.min_exposure_s, control_.max_exposure_s);
  const double gain = exposure_times_gain_s / settings.exposure_s;
  settings.gain = 1.0 + to_step(gain - 1.0, control_.gain_step, 0.0, control_.max_gain - 1.0);
  return settings;
}

}  // namespace plumbline
