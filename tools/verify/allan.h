#pragma once

#include <cstddef>
#include <vector>

#include "sensors/imu_noise.h"

/// Allan variance: half the mean square difference of neighbouring averages over a time (IEEE Std 952-1997, annex C).
namespace plumbline {

struct AllanPoint {
  std::size_t samples = 1;  ///< per average
  double tau_s = 0.0;       ///< the averages' time
  double variance = 0.0;    ///< [unit^2]
};

/// The overlapping estimate (NIST SP 1065, eq. 11) at every octave of averaging time that fits the log at least nine
/// times.
std::vector<AllanPoint> allan_variance(const std::vector<double>& values, double rate_hz);

/// What the estimate should come to.
struct AllanExpectation {
  double variance = 0.0;
  double degrees_of_freedom = 0.0;  ///< the estimate times this over the variance is about chi-squared distributed
};

/// The Allan variance of logs of TriadNoise, rounded to steps, and the spread of the overlapping estimate, from the
/// processes' autocovariance.
class AllanModel {
 public:
  /// @param resolution  the output's step; its rounding is taken as white noise of variance step^2 / 12
  /// @param samples     length of the log
  AllanModel(const NoiseFigures& figures, double resolution, double rate_hz, std::size_t samples);

  /// @param samples  per average: a power of two, at most a ninth of the log
  AllanExpectation at(std::size_t samples) const;

 private:
  double covariance_of_differences(std::size_t samples, std::size_t lag) const;

  /// Variance of the sum of so many samples, up to what differences of averages do not see.
  std::vector<double> sum_variance_;
};

/// A range that holds an estimate with a probability.
struct AllanBand {
  double low = 0.0;
  double high = 0.0;
};
AllanBand band_of(const AllanExpectation& expectation, double probability);

/// Figures that a log gives back, each from the stretch of the curve that shows it.
/// N: least squares of N^2 / tau + constant + slope * tau, the points weighted by their spread. [unit / sqrt(Hz)]
double fitted_density(const std::vector<AllanPoint>& curve, double resolution, double rate_hz);
/// B: of a log of flicker noise alone, the level between 8 and 1100 s over 0.664. [unit]
double fitted_bias_instability(const std::vector<AllanPoint>& curve);
/// K: of a log of random walk alone, from variance = K^2 tau / 3 up to 100 s. [unit / s / sqrt(Hz)]
double fitted_random_walk(const std::vector<AllanPoint>& curve);

}  // namespace plumbline
