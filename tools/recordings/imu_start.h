#pragma once

#include <filesystem>

#include "tools/recordings/check_row.h"

namespace plumbline {

/// A folder in EuRoC's format with a true path (state_groundtruth_estimate0, or a gt*.txt beside imu0).
bool has_imu_and_truth(const std::filesystem::path& folder);

/// Static initialisation, where the recording begins at rest, against the true attitude, and a second of propagation by
/// the IMU alone from every second of the truth, with the biases that the rest showed.
CheckRows check_imu(const std::filesystem::path& folder);

}  // namespace plumbline
