#pragma once

#include <cstdint>
#include <vector>

#include "sensors/sensor_chip.h"

/// A chip's photon transfer curve and what it gives back, as EMVA 1288 measures them. Counts are of 10 bits.
namespace plumbline {

/// A flat field's mean and temporal variance, from the difference of a pair of images.
struct FlatField {
  double mean = 0.0;
  double variance = 0.0;  ///< of one image, quantisation taken off
};

struct PhotonTransfer {
  double gain = 1.0;  ///< of the amplifier
  FlatField dark;
  std::vector<FlatField> fields;  ///< from dark to beyond the full well
  double electrons_per_count = 0.0;
  double read_noise_electrons = 0.0;
  double full_well_electrons = 0.0;
};

/// Least squares of variance over mean up to 70 % of saturation, which is where the variance is greatest; at the gain
/// that puts the full well at 70 % of the converter's range. Dark current is left out: EMVA extrapolates to no
/// exposure.
PhotonTransfer measure_photon_transfer(SensorChip chip);

/// What a chip's figures make of an amplifier's gain.
double electrons_per_count(const SensorChip& chip, double gain);

}  // namespace plumbline
