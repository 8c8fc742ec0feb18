#include "sensors/lidar_signal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

constexpr double kReferenceReflectivity = 0.1;  // of LidarModel::range_at_10_percent_m
constexpr double kFwhmOverSigma = 2.3548;
// Of a Gaussian beam, whose full width is taken where it has fallen to 1/e^2.
constexpr double kWidthOverSigma = 4.0;
// Weaker echoes are found by luck only, and their noise cannot exceed what the search window lets through.
constexpr double kWeakest = 0.5;

double square(double x) { return x * x; }

}  // namespace

LidarSignal::LidarSignal(const LidarModel& model)
    : scale_(square(model.range_at_10_percent_m) / kReferenceReflectivity),
      variance_(square(model.range_sigma_m)),
      variance_at_limit_(square(model.range_sigma_at_limit_m)),
      inverse_pulse_variance_(1.0 / square(0.5 * kSpeedOfLight_mps * model.pulse_s / kFwhmOverSigma)),
      exit_sigma_m_(std::max(model.exit_width_m, model.exit_height_m) / kWidthOverSigma),
      divergence_sigma_(std::max(model.divergence_horizontal_rad, model.divergence_vertical_rad) / kWidthOverSigma) {}

double LidarSignal::spread_m(double range_m, double cos_incidence) const {
  const double sine_squared = std::max(0.0, 1.0 - square(cos_incidence));
  return (exit_sigma_m_ + range_m * divergence_sigma_) * std::sqrt(sine_squared) / std::max(cos_incidence, 1e-2);
}

double LidarSignal::detection_probability(double strength) const {
  return 0.5 * std::erfc(-kThreshold * (strength - 1.0) / std::numbers::sqrt2);
}

double LidarSignal::range_sigma_m(double strength, double spread_m) const {
  const double broadening = 1.0 + square(spread_m) * inverse_pulse_variance_;
  return std::sqrt(variance_ + variance_at_limit_ * broadening / std::max(strength, kWeakest));
}

double expected_range_sigma_m(const LidarModel& model, double range_m, double reflectivity, double incidence_rad) {
  const LidarSignal signal(model);
  const double cos_incidence = std::cos(incidence_rad);
  return signal.range_sigma_m(signal.strength(range_m, reflectivity * cos_incidence),
                              signal.spread_m(range_m, cos_incidence));
}

double expected_return_share(const LidarModel& model, double range_m, double reflectivity, double incidence_rad) {
  const LidarSignal signal(model);
  return signal.detection_probability(signal.strength(range_m, reflectivity * std::cos(incidence_rad)));
}

}  // namespace plumbline
