#include "tools/verify/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {
namespace {

FlatField flat_field(const SensorChip& chip, double gain, double electrons, std::uint64_t seed) {
  constexpr int kSide = 256;
  const std::vector<float> light(kSide * kSide, static_cast<float>(electrons));
  const ExposureSettings settings{1e-3, gain};
  const RawImage a = read_out(chip, settings, {}, light, kSide, kSide, seed);
  const RawImage b = read_out(chip, settings, {}, light, kSide, kSide, seed ^ 0x9e3779b97f4a7c15ULL);
  FlatField field;
  for (std::size_t i = 0; i < a.counts.size(); ++i) {
    const double difference = static_cast<double>(a.counts[i]) - b.counts[i];
    field.mean += 0.5 * (a.counts[i] + b.counts[i]);
    field.variance += 0.5 * difference * difference;
  }
  const auto n = static_cast<double>(a.counts.size());
  field.mean /= n;
  field.variance = field.variance / n - 1.0 / 12.0;
  return field;
}

}  // namespace

double electrons_per_count(const SensorChip& chip, double gain) { return 0.25 * chip.electrons_per_dn / gain; }

PhotonTransfer measure_photon_transfer(SensorChip chip) {
  chip.dark_current_electrons_per_s = 0.0;
  const double gain = 0.7 * 1000.0 * electrons_per_count(chip, 1.0) / chip.full_well_electrons;
  constexpr int kLevels = 60;
  const FlatField dark = flat_field(chip, gain, 0.0, 1);
  std::vector<FlatField> fields;
  for (int i = 1; i <= kLevels; ++i) {
    const double electrons = 1.2 * chip.full_well_electrons * i / kLevels;
    fields.push_back(flat_field(chip, gain, electrons, static_cast<std::uint64_t>(100 + i)));
  }
  const auto saturation = std::max_element(
      fields.begin(), fields.end(), [](const FlatField& a, const FlatField& b) { return a.variance < b.variance; });
  const double saturation_signal = saturation->mean - dark.mean;
  double products = 0.0;
  double squares = 0.0;
  for (const FlatField& field : fields) {
    const double signal = field.mean - dark.mean;
    if (signal > 0.7 * saturation_signal) continue;
    products += signal * (field.variance - dark.variance);
    squares += signal * signal;
  }
  PhotonTransfer found{gain, dark, std::move(fields), squares / products, 0.0, 0.0};
  found.read_noise_electrons = std::sqrt(dark.variance) * found.electrons_per_count;
  found.full_well_electrons = saturation_signal * found.electrons_per_count;
  return found;
}

}  // namespace plumbline
