#pragma once

#include <filesystem>
#include <vector>

#include "estimator/geometry/interpolation.h"

namespace plumbline {

inline constexpr double kQuaternionTolerance = 0.01;  ///< of the length of a true attitude, which should be one

/// True poses from a file of their own: TUM's "stamp_s x y z qx qy qz qw", or EuRoC's comma-separated
/// "stamp_ns, x, y, z, qw, qx, qy, qz, …". @throws InputError
std::vector<PoseTrack::Stamped> read_truth_file(const std::filesystem::path& path);

}  // namespace plumbline
