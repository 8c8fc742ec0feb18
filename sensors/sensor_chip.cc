#include "sensors/sensor_chip.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "sensors/photon_noise.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr int kCountsPerDn = 4;  // ten bits to eight

/// One frame's way from electrons to counts.
struct Converter {
  float dark_electrons = 0.0F;
  float full_well = 0.0F;
  float read_noise = 0.0F;
  float counts_per_electron = 0.0F;
  float pedestal = 0.0F;

  Converter(const SensorChip& chip, const ExposureSettings& settings, const ChipNoise& noise)
      : dark_electrons(noise.dark_current ? static_cast<float>(chip.dark_current_electrons_per_s * settings.exposure_s)
                                          : 0.0F),
        full_well(static_cast<float>(chip.full_well_electrons)),
        read_noise(noise.read ? static_cast<float>(chip.read_noise_electrons) : 0.0F),
        counts_per_electron(static_cast<float>(kCountsPerDn * settings.gain / chip.electrons_per_dn)),
        pedestal(static_cast<float>(kCountsPerDn * chip.black_level_dn)) {}

  std::uint16_t counts(float electrons, float read_draw) const {
    const float charge = std::min(electrons, full_well) + read_draw * read_noise;
    const float value = pedestal + charge * counts_per_electron;
    return static_cast<std::uint16_t>(std::clamp(value, 0.0F, static_cast<float>(RawImage::kMostCounts)) + 0.5F);
  }
};

}  // namespace

void validate_or_throw(const SensorChip& chip, const std::string& owner) {
  const auto require = [&owner](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(owner + ": " + rule);
  };
  require(chip.electrons_per_dn > 0.0, "electrons_per_dn must be positive");
  require(chip.read_noise_electrons >= 0.0, "read_noise_electrons must not be negative");
  require(chip.dark_current_electrons_per_s >= 0.0, "dark_current_electrons_per_s must not be negative");
  require(chip.full_well_electrons > 0.0, "full_well_electrons must be positive");
  require(chip.electrons_per_lux_second > 0.0, "electrons_per_lux_second must be positive");
  require(chip.black_level_dn >= 0.0 && chip.black_level_dn < 255.0, "black_level_dn must be within [0, 255)");
}

double RawImage::mean_dn() const {
  const auto sum = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  return static_cast<double>(sum) / (kCountsPerDn * static_cast<double>(counts.size()));
}

std::vector<std::uint8_t> RawImage::upper_eight_bits() const {
  std::vector<std::uint8_t> pixels(counts.size());
  std::transform(counts.begin(), counts.end(), pixels.begin(),
                 [](std::uint16_t count) { return static_cast<std::uint8_t>(count / kCountsPerDn); });
  return pixels;
}

RawImage read_out(const SensorChip& chip, const ExposureSettings& settings, const ChipNoise& noise,
                  std::span<const float> mean_electrons, int width, int height, std::uint64_t frame_seed) {
  const Converter converter(chip, settings, noise);
  RawImage raw;
  raw.width = width;
  raw.height = height;
  raw.channels =
      static_cast<int>(mean_electrons.size() / (static_cast<std::size_t>(width) * static_cast<std::size_t>(height)));
  raw.counts.resize(mean_electrons.size());
  const NoiseTables& draws = noise_tables();
  for (std::size_t i = 0; i < mean_electrons.size(); ++i) {
    const std::uint64_t bits = mix_bits(frame_seed + i);
    const float mean = mean_electrons[i] + converter.dark_electrons;
    const float electrons = noise.shot ? draws.photons(mean, bits) : mean;
    raw.counts[i] = converter.counts(electrons, draws.gaussian(bits >> 32));
  }
  return raw;
}

}  // namespace plumbline
