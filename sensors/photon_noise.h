#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace plumbline {

/// Draws of noise from the bits of a hash, a table look-up each: std::poisson_distribution takes fifty times as long.
/// The tables hold the distributions' quantiles at the middles of equally likely classes, so draws stop at the
/// outermost of them: 3.8 standard deviations.
class NoiseTables {
 public:
  NoiseTables();

  /// Standard normal; uses 13 bits.
  float gaussian(std::uint64_t bits) const { return gaussian_[bits & (kGaussianSize - 1)]; }

  /// Electrons of a mean number; uses 28 bits. Poisson up to kMostCounted, beyond that the normal distribution of the
  /// same mean and variance, which then differs by less than its own discreteness.
  float photons(float mean, std::uint64_t bits) const;

  static constexpr int kMostCounted = 50;

 private:
  static constexpr std::size_t kGaussianSize = 8192;
  static constexpr std::size_t kPoissonSize = 4096;
  static constexpr int kMeansPerElectron = 8;

  float counted(float mean, std::uint64_t bits) const;

  std::array<float, kGaussianSize> gaussian_;
  std::vector<std::uint8_t> poisson_;  ///< kPoissonSize quantiles for each multiple of 1/kMeansPerElectron from 0
};

/// The one copy of them.
const NoiseTables& noise_tables();

}  // namespace plumbline
