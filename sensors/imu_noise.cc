#include "sensors/imu_noise.h"

#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

constexpr double kShortest_s = 1.0;
constexpr double kRatio = 4.0;
constexpr int kProcesses = 8;

}  // namespace

Eigen::Vector3d gaussian_vector(RandomStream& stream) {
  const double x = stream.gaussian();
  const double y = stream.gaussian();
  const double z = stream.gaussian();
  return {x, y, z};
}

// One process has the spectrum 4 sigma^2 T / (1 + (2 pi f T)^2). Summed over T at a dense ratio r this tends to
// sigma^2 / (ln(r) f), which is B^2 / (pi f) for sigma^2 = B^2 ln(r) / pi. The sum's relative ripple over f is
// 2 / cosh(pi^2 / ln r).
std::vector<GaussMarkov> flicker_processes(double bias_instability) {
  const double sigma = bias_instability * std::sqrt(std::log(kRatio) / std::numbers::pi);
  std::vector<GaussMarkov> processes;
  for (int i = 0; i < kProcesses; ++i) processes.push_back({kShortest_s * std::pow(kRatio, i), sigma});
  return processes;
}

int samples_per_bias_step(double rate_hz) {
  int samples = 1;
  while (2.0 * samples <= 0.04 * rate_hz) samples *= 2;
  return samples;
}

WanderingBias::WanderingBias(const NoiseFigures& figures, double step_s, std::uint64_t seed, const std::string& name)
    : walk_step_(figures.random_walk * std::sqrt(step_s)),
      flicker_stream_(seed, name + ".flicker"),
      walk_stream_(seed, name + ".walk") {
  if (figures.bias_instability <= 0.0) return;
  for (const GaussMarkov& process : flicker_processes(figures.bias_instability)) {
    const double decay = std::exp(-step_s / process.time_constant_s);
    flicker_.push_back(
        {decay, process.sigma * std::sqrt(1.0 - decay * decay), process.sigma * gaussian_vector(flicker_stream_)});
  }
}

Eigen::Vector3d WanderingBias::next() {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (Process& process : flicker_) {
    process.value = process.decay * process.value + process.driven * gaussian_vector(flicker_stream_);
    bias += process.value;
  }
  if (walk_step_ > 0.0) walk_ += walk_step_ * gaussian_vector(walk_stream_);
  return bias + walk_;
}

TriadNoise::TriadNoise(const NoiseFigures& figures, double rate_hz, std::uint64_t seed, const std::string& name)
    : wandering_(figures, samples_per_bias_step(rate_hz) / rate_hz, seed, name),
      samples_per_step_(samples_per_bias_step(rate_hz)),
      white_sigma_(figures.density * std::sqrt(rate_hz)),
      white_stream_(seed, name + ".white") {}

Eigen::Vector3d TriadNoise::next() {
  if (until_step_ == 0) {
    bias_ = wandering_.next();
    until_step_ = samples_per_step_;
  }
  --until_step_;
  return white_sigma_ > 0.0 ? Eigen::Vector3d(bias_ + white_sigma_ * gaussian_vector(white_stream_)) : bias_;
}

}  // namespace plumbline
