#pragma once

#include <cmath>
#include <cstdint>

#include "sim/random_stream.h"

namespace plumbline {

/// gaussian_quantile in its tails. @param q  probability - 0.5, more than 0.425 from 0
double gaussian_quantile_in_tail(double probability, double q);

/// The standard normal distribution's quantile of a probability in (0, 1), to 1e-6. Wichura, Applied Statistics 37(3),
/// 1988, algorithm AS 241, PPND7.
inline double gaussian_quantile(double probability) {
  const double q = probability - 0.5;
  if (std::abs(q) > 0.425) return gaussian_quantile_in_tail(probability, q);
  const double r = 0.180625 - q * q;
  return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
         (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1.0);
}

/// What one laser's firing draws. A draw depends on the firing and on what it is for, never on other draws, so a change
/// in the world leaves the noise of what did not change as it was.
class FiringNoise {
 public:
  enum class Source : std::uint64_t {
    kRange,  ///< of the first return; the second has the next number
    kSecondRange,
    kDetection,  ///< of the first echo; the others follow
    kFootprint = 32,
    kFog,
    kFogDensity,
    kDust,
    kDustDensity,
    kRain,
    kRainPlace,
    kRainDrop
  };

  /// @param firing  unique to the firing, and well mixed
  explicit FiringNoise(std::uint64_t firing) : firing_(firing) {}

  /// (0, 1)
  double uniform(Source source, unsigned index = 0) const {
    const std::uint64_t bits = mix_bits(firing_ ^ ((static_cast<std::uint64_t>(source) + index) << 56U));
    return (static_cast<double>(bits >> 12U) + 0.5) * 0x1.0p-52;
  }
  /// Mean 0, standard deviation 1.
  double gaussian(Source source) const { return gaussian_quantile(uniform(source)); }

 private:
  std::uint64_t firing_;
};

}  // namespace plumbline
