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

void append_poisson_quantiles(int mean, std::size_t size, std::vector<std::uint8_t>& out) {
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
  poisson_.reserve((kMostCounted + 1) * kPoissonSize);
  for (int mean = 0; mean <= kMostCounted; ++mean) append_poisson_quantiles(mean, kPoissonSize, poisson_);
}

float NoiseTables::photons(float mean, std::uint64_t bits) const {
  if (mean <= static_cast<float>(kMostCounted)) return counted(mean, bits);
  return mean + gaussian(bits) * std::sqrt(mean);
}

/// A Poisson number of a mean is the sum of two of its whole part, from the table, and of the rest, by inversion.
float NoiseTables::counted(float mean, std::uint64_t bits) const {
  if (mean <= 0.0F) return 0.0F;
  const auto whole = static_cast<std::size_t>(mean);
  const float rest = mean - static_cast<float>(whole);
  int count = poisson_[whole * kPoissonSize + (bits & (kPoissonSize - 1))];
  const float draw = (static_cast<float>((bits >> 12) & 0xFFFF) + 0.5F) * 0x1.0p-16F;
  float probability = std::exp(-rest);
  float cumulative = probability;
  // The 65,536 draws end within nine counts of a mean below 1.
  for (int more = 1; cumulative < draw && more < 10; ++more) {
    ++count;
    probability *= rest / static_cast<float>(more);
    cumulative += probability;
  }
  return static_cast<float>(count);
}

}  // namespace plumbline
