#pragma once

#include <filesystem>
#include <vector>

#include "estimator/geometry/interpolation.h"

namespace plumbline {

/// Reads a trajectory as the TUM RGB-D benchmark writes it: "stamp_s x y z qx qy qz qw" a line, '#' comments.
/// Stamps are read exactly, digit by digit, never through a floating-point number.
/// @throws std::invalid_argument naming file and line, what was found and what is allowed: fewer or more than eight
/// numbers, a number that is not finite or absurdly large, a quaternion that is not of unit length (within 1 %), a
/// stamp that is not later than the one before; or naming the file if it cannot be read, is too large or holds no pose.
std::vector<PoseTrack::Stamped> read_tum_file(const std::filesystem::path& path);

}  // namespace plumbline
