#include "sensors/photon_noise.h"

#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

/// The upper half of the standard normal's quantiles by Newton's method from the median outwards, each starting at its
/// neighbour; the lower half mirrors it. Scaled to unit variance.
template <std::size_t kSize>
std::array<float, kSize> gaussian_quantiles() {
  std::array<float, kSize> values;
  double x = 0.0;
  double sum_of_squares = 0.0;
  for (std::size_t i = kSize / 2; i < kSize; ++i) {
    const double probability = (static_cast<double>(i) + 0.5) / kSize;
    for (int iteration = 0; iteration < 8; ++iteration) {
      const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
      x += (probability - 0.5 * std::erfc(-x / std::numbers::sqrt2)) / density;
    }
    values[i] = static_cast<float>(x);
    sum_of_squares += 2.0 * x * x;
  }
  const auto scale = static_cast<float>(std::sqrt(kSize / sum_of_squares));
  for (std::size_t i = kSize / 2; i < kSize; ++i) {
    values[i] *= scale;
    values[kSize - 1 - i] = -values[i];
  }
  return values;
}

void append_poisson_quantiles(double mean, std::size_t size, std::vector<std::uint8_t>& out) {
  int count = 0;
  double probability = std::exp(-mean);
  double cumulative = probability;
  for (std::size_t i = 0; i < size; ++i) {
    const double quantile = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
    while (cumulative < quantile) {
      ++count;
      probability *= mean / static_cast<double>(count);
      cumulative += probability;
    }
    out.push_back(static_cast<std::uint8_t>(count));
  }
}

}  // namespace

NoiseTables::NoiseTables() : gaussian_(gaussian_quantiles<kGaussianSize>()) {
  constexpr int kMeans = kMostCounted * kMeansPerElectron + 1;
  poisson_.reserve(kMeans * kPoissonSize);
  for (int i = 0; i < kMeans; ++i) {
    append_poisson_quantiles(static_cast<double>(i) / kMeansPerElectron, kPoissonSize, poisson_);
  }
}

float NoiseTables::photons(float mean, std::uint64_t bits) const {
  if (mean <= static_cast<float>(kMostCounted)) return mean > 0.0F ? counted(mean, bits) : 0.0F;
  return mean + gaussian(bits) * std::sqrt(mean);
}

/// A Poisson number of a mean is the sum of two: of the multiple of 1/8 below it, from the table, and of the rest, by
/// inversion. The rest being small, its exponential is a short series (to 3e-7) and its number seldom more than 0.
float NoiseTables::counted(float mean, std::uint64_t bits) const {
  const float steps = mean * static_cast<float>(kMeansPerElectron);
  const auto whole = static_cast<std::size_t>(steps);
  const float rest = (steps - static_cast<float>(whole)) / static_cast<float>(kMeansPerElectron);
  int count = poisson_[whole * kPoissonSize + (bits & (kPoissonSize - 1))];
  const float draw = (static_cast<float>((bits >> 12) & 0xFFFF) + 0.5F) * 0x1.0p-16F;
  float probability = 1.0F - rest * (1.0F - rest * (0.5F - rest * (1.0F / 6.0F - rest / 24.0F)));
  float cumulative = probability;
  // 65,536 draws of a mean below 1/8 end within five counts.
  for (int more = 1; cumulative < draw && more < 6; ++more) {
    ++count;
    probability *= rest / static_cast<float>(more);
    cumulative += probability;
  }
  return static_cast<float>(count);
}

const NoiseTables& noise_tables() {
  static const NoiseTables kTables;
  return kTables;
}

}  // namespace plumbline
