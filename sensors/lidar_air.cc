#include "sensors/lidar_air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

using Source = FiringNoise::Source;

constexpr double kPi = std::numbers::pi;
constexpr double kKoschmieder = 3.912;
constexpr double kDropletLidarRatio_sr = 18.8;
constexpr double kDustLidarRatio_sr = 50.0;
constexpr double kClumpShare = 0.1;
// Nearer than this the receiver does not see all of the beam.
constexpr double kOverlap_m = 2.0;
constexpr double kLeastDrop_m = 1e-3;
constexpr double kRainReach_m = 15.0;  // no drop returns from farther away
// A sphere's extinction is twice its section: pi beta over the number's section, as above.
constexpr double kDropReflectivity = 2.0 * kPi / kDropletLidarRatio_sr;

double extinction_of_visibility(double visibility_m) { return kKoschmieder / visibility_m; }

double extinction_of_rain(double mm_per_h) {
  constexpr double kDecibelPerKilometre = std::numbers::ln10 / 10.0 / 1000.0;
  return 1.076 * std::pow(mm_per_h, 0.67) * kDecibelPerKilometre;
}

double exponential(double uniform) { return -std::log(uniform); }

}  // namespace

LidarAir::LidarAir(const Atmosphere& atmosphere, const LidarModel& model)
    : width_m_(std::sqrt(model.exit_width_m * model.exit_height_m)),
      divergence_(std::sqrt(model.divergence_horizontal_rad * model.divergence_vertical_rad)) {
  const double fog = extinction_of_visibility(atmosphere.fog_visibility_m);
  const double dust = extinction_of_visibility(atmosphere.dust_visibility_m);
  const double pulse_m = 0.5 * kSpeedOfLight_mps * model.pulse_s;
  extinction_per_m_ = fog + dust;
  fog_reflectivity_ = kPi * fog / kDropletLidarRatio_sr * pulse_m;
  dust_reflectivity_ = kPi * dust / kDustLidarRatio_sr * pulse_m / kClumpShare;
  clump_spacing_m_ = pulse_m / kClumpShare;
  const double rain = atmosphere.rain_mm_per_h;
  if (rain <= 0.0) return;
  extinction_per_m_ += extinction_of_rain(rain);
  const double slope_per_m = 4100.0 * std::pow(rain, -0.21);  // Marshall and Palmer: N(D) = 8e6 exp(-slope D) per m^4
  drops_per_m3_ = 8e6 / slope_per_m * std::exp(-slope_per_m * kLeastDrop_m);
  drop_scale_m_ = 1.0 / slope_per_m;
}

double LidarAir::transmission(double range_m) const { return std::exp(-2.0 * extinction_per_m_ * range_m); }

void LidarAir::add_echoes(const LidarSignal& signal, const FiringNoise& noise, double until_m,
                          LidarEchoes& echoes) const {
  if (fog_reflectivity_ > 0.0) add_fog(signal, noise, until_m, echoes);
  if (dust_reflectivity_ > 0.0) add_dust(signal, noise, until_m, echoes);
  if (drops_per_m3_ > 0.0) add_rain(signal, noise, until_m, echoes);
}

void LidarAir::add(const LidarSignal& signal, double range_m, double reflectivity, LidarEchoes& echoes) const {
  echoes.add({range_m, signal.strength(range_m, reflectivity, transmission(range_m)), 0.0});
}

void LidarAir::add_fog(const LidarSignal& signal, const FiringNoise& noise, double until_m, LidarEchoes& echoes) const {
  if (until_m <= kOverlap_m) return;
  const double range_m = kOverlap_m / (1.0 - noise.uniform(Source::kFog) * (1.0 - kOverlap_m / until_m));
  add(signal, range_m, fog_reflectivity_ * exponential(noise.uniform(Source::kFogDensity)), echoes);
}

void LidarAir::add_dust(const LidarSignal& signal, const FiringNoise& noise, double until_m,
                        LidarEchoes& echoes) const {
  const double range_m = kOverlap_m + clump_spacing_m_ * exponential(noise.uniform(Source::kDust));
  if (range_m >= until_m) return;
  add(signal, range_m, dust_reflectivity_ * exponential(noise.uniform(Source::kDustDensity)), echoes);
}

void LidarAir::add_rain(const LidarSignal& signal, const FiringNoise& noise, double until_m,
                        LidarEchoes& echoes) const {
  const double reach_m = std::min(until_m, kRainReach_m);
  // The beam is a cone; its volume grows with the cube of its width.
  const double narrow = std::pow(width_m_, 3);
  const double wide = std::pow(beam_width_m(reach_m), 3);
  const double volume_m3 = kPi / 12.0 * (wide - narrow) / divergence_;
  if (noise.uniform(Source::kRain) < std::exp(-drops_per_m3_ * volume_m3)) return;
  const double width_m = std::cbrt(narrow + noise.uniform(Source::kRainPlace) * (wide - narrow));
  const double range_m = (width_m - width_m_) / divergence_;
  if (range_m < kOverlap_m) return;
  const double drop_m = kLeastDrop_m + drop_scale_m_ * exponential(noise.uniform(Source::kRainDrop));
  const double share_of_beam = std::min(1.0, drop_m * drop_m / (width_m * width_m));
  add(signal, range_m, kDropReflectivity * share_of_beam, echoes);
}

}  // namespace plumbline
