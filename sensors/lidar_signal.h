#pragma once

#include "sensors/lidar_model.h"

namespace plumbline {

/// How much light comes back, and what that does to a return. The strength of an echo is its signal over that of a
/// plate of 10 % reflectivity, seen head-on at LidarModel::range_at_10_percent_m, which is found half of the time.
///
///   strength  = (rho cos(alpha) / 0.1) (range_at_10_percent / r)^2 T^2   extended Lambertian target, T through the air
///   detection = Phi(kThreshold (strength - 1))                           Gaussian noise at a fixed threshold
///   sigma^2   = sigma_0^2 + sigma_limit^2 / strength (1 + (spread / pulse)^2)
///
/// The last is the jitter of a pulse's time of arrival, limited by shot noise: it falls with the square root of the
/// signal and grows with the pulse's length, which a footprint that reaches over a spread of ranges adds to. Sources:
/// Hoefle and Pfeifer, ISPRS J. 62(6), 2007, eq. 7 (the signal); Soudarissanane et al., ISPRS Archives 38, 2009
/// (incidence acts through the signal); Ouster's OS1 data sheet gives sigma for three signal-to-noise ratios, which
/// fall on this curve within 30 %.
class LidarSignal {
 public:
  /// The threshold of detection over the noise: false alarms at 3e-7 a sample.
  static constexpr double kThreshold = 5.0;

  explicit LidarSignal(const LidarModel& model);

  /// @param reflectivity_towards_lidar  rho cos(alpha), times the share of the beam that meets the surface
  /// @param transmission  T^2, of the way there and back
  double strength(double range_m, double reflectivity_towards_lidar, double transmission = 1.0) const {
    return reflectivity_towards_lidar * transmission * scale_ / (range_m * range_m);
  }
  /// The inverse as a device that compensates for range knows it: rho cos(alpha) T^2.
  double intensity(double range_m, double strength) const { return strength * range_m * range_m / scale_; }

  /// Standard deviation of the ranges within the footprint on a plane [m].
  double spread_m(double range_m, double cos_incidence) const;
  double detection_probability(double strength) const;
  double range_sigma_m(double strength, double spread_m) const;

 private:
  double scale_ = 0.0;
  double variance_ = 0.0;
  double variance_at_limit_ = 0.0;
  double inverse_pulse_variance_ = 0.0;  ///< of the pulse's length as a range
  double exit_sigma_m_ = 0.0;
  double divergence_sigma_ = 0.0;
};

/// The white noise that the model expects of a return from a plane in clear air, quantisation not included [m].
double expected_range_sigma_m(const LidarModel& model, double range_m, double reflectivity, double incidence_rad);

/// The share of firings at such a plane that return.
double expected_return_share(const LidarModel& model, double range_m, double reflectivity, double incidence_rad);

}  // namespace plumbline
