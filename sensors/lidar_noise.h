#pragma once

#include <cstdint>

#include "sim/random_stream.h"

namespace plumbline {

/// The standard normal distribution's quantile of a probability in (0, 1), to 1e-6. Wichura, Applied Statistics 37(3),
/// 1988, algorithm AS 241, PPND7.
double gaussian_quantile(double probability);

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
