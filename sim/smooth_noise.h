#pragma once

#include <cmath>
#include <vector>

#include "sim/random_stream.h"

namespace plumbline {

/// A smooth random function of time within a band of frequencies, of standard deviation 1: a sum of sines that never
/// repeats.
class SmoothNoise {
 public:
  SmoothNoise(RandomStream& stream, double low_hz, double high_hz) {
    constexpr int kSines = 16;
    for (int i = 0; i < kSines; ++i) {
      const double slice = (high_hz - low_hz) / kSines;
      const double hz = low_hz + slice * (i + stream.uniform());
      waves_.push_back({2.0 * M_PI * hz, stream.uniform(0.0, 2.0 * M_PI)});
    }
  }

  double at(double time_s) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::sin(wave.rate * time_s + wave.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    double rate;  // [rad/s]
    double phase;
  };
  std::vector<Wave> waves_;
};

}  // namespace plumbline
