#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

/// An image sensor with a 10-bit converter, as EMVA 1288 describes one: photons make electrons, electrons are amplified
/// and counted. DN are counts of the 8-bit output, the converter's upper eight bits; a 10-bit count is a quarter of
/// one.
struct SensorChip {
  double electrons_per_dn = 85.0;  ///< at unit gain; EuRoC MT9V034 as measured
  double read_noise_electrons = 29.0;
  double dark_current_electrons_per_s = 0.0;  ///< in every pixel, added to what light makes
  double full_well_electrons = 21600.0;
  double electrons_per_lux_second = 7.36e4;  ///< in a pixel, per lux on the sensor; see camera.cc for the derivation
  double black_level_dn = 5.0;               ///< what darkness reads, so that its noise is not cut off at 0
};

/// @throws std::invalid_argument "OWNER: rule" naming the field that is out of range.
void validate_or_throw(const SensorChip& chip, const std::string& owner);

struct ExposureSettings {
  double exposure_s = 2e-3;
  double gain = 1.0;
};

/// Which noise there is. Quantisation and the limits of well and converter always are.
struct ChipNoise {
  bool shot = true;          ///< Poisson's, of light and of dark current
  bool dark_current = true;  ///< its mean
  bool read = true;
};

/// The converter's output, row-major, `channels` values a pixel.
struct RawImage {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<std::uint16_t> counts;  ///< 10 bits

  static constexpr int kMostCounts = 1023;
  double mean_dn() const;
  std::vector<std::uint8_t> upper_eight_bits() const;
};

/// Reads a chip out: electrons (Poisson) up to the full well, read noise, gain, pedestal, rounding to 10 bits.
/// @param mean_electrons  that light makes in the exposure, width * height * channels of them
/// @param frame_seed      the noise's: the same gives the same bytes
RawImage read_out(const SensorChip& chip, const ExposureSettings& settings, const ChipNoise& noise,
                  std::span<const float> mean_electrons, int width, int height, std::uint64_t frame_seed);

}  // namespace plumbline
