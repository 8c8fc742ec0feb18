#pragma once

#include "tools/formats/dataset.h"

namespace plumbline {

/// The file that a dataset of ours holds whatever its format, and that stands above the format's own calibration.
inline constexpr const char* kDatasetCalibration = "calibration.yaml";

/// A calibration as a format gives it, made whole: replaced by the folder's calibration.yaml if there is one, then the
/// catalogue's figures of the devices that the settings name, then the settings' keys.
/// @param folder  empty: there is none
/// @throws InputError
Calibration complete_calibration(const Calibration& native, const std::filesystem::path& folder,
                                 const DatasetSettings& settings);

}  // namespace plumbline
