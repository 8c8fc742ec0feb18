#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/random_stream.h"

/// The random errors of a gyroscope's or an accelerometer's axes, in the terms of IEEE Std 952-1997, annex C: white
/// noise N, bias instability B (flicker noise, power spectral density B^2 / (pi f), one-sided) and rate random walk
/// K.
namespace plumbline {

/// Figures of one axis; unit is rad/s or m/s^2.
struct NoiseFigures {
  double density = 0.0;           ///< N [unit / sqrt(Hz)]
  double bias_instability = 0.0;  ///< B [unit]; the Allan deviation's floor is 0.664 B
  double random_walk = 0.0;       ///< K [unit / s / sqrt(Hz)]
};

/// A first-order Gauss-Markov process: autocovariance sigma^2 exp(-lag / time_constant_s).
struct GaussMarkov {
  double time_constant_s = 1.0;
  double sigma = 0.0;
};

/// Processes whose sum is flicker noise between 1 s and 4.5 h: time constants at every factor of four, all of one
/// variance. The spectrum's ripple is 0.3 %. Below a second white noise buries it in every device.
std::vector<GaussMarkov> flicker_processes(double bias_instability);

/// The bias is renewed every so many samples: a power of two, about 0.04 s.
int samples_per_bias_step(double rate_hz);

/// The wandering part of three axes' bias: flicker noise, stationary from the start, and random walk, which starts at
/// zero. Each draws from its own stream.
class WanderingBias {
 public:
  /// @param name  of the triad, for its streams
  WanderingBias(const NoiseFigures& figures, double step_s, std::uint64_t seed, const std::string& name);

  /// Goes on by one step. @return the bias then
  Eigen::Vector3d next();

 private:
  struct Process {
    double decay = 0.0;   ///< per step
    double driven = 0.0;  ///< standard deviation of what a step adds
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };

  std::vector<Process> flicker_;
  double walk_step_ = 0.0;
  Eigen::Vector3d walk_ = Eigen::Vector3d::Zero();
  RandomStream flicker_stream_;
  RandomStream walk_stream_;
};

/// All random errors of three axes, sample by sample.
class TriadNoise {
 public:
  TriadNoise(const NoiseFigures& figures, double rate_hz, std::uint64_t seed, const std::string& name);

  /// The error of the next sample, a mean over one interval.
  Eigen::Vector3d next();

 private:
  WanderingBias wandering_;
  int samples_per_step_ = 1;
  int until_step_ = 0;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double white_sigma_ = 0.0;
  RandomStream white_stream_;
};

/// Three independent draws, mean 0, standard deviation 1.
Eigen::Vector3d gaussian_vector(RandomStream& stream);

}  // namespace plumbline
