#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimator/geometry/interpolation.h"

/// Trajectories as the TUM RGB-D benchmark writes them: "stamp_s x y z qx qy qz qw" a line, '#' comments.
namespace plumbline {

/// Stamps are read exactly, digit by digit, never through a floating-point number.
/// @throws InputError naming file and line, what was found and what is allowed: fewer or more than eight numbers, a
/// number that is not finite or absurdly large, a quaternion that is not of unit length (within 1 %), a stamp that is
/// not later than the one before; or naming the file if it cannot be read, is too large or holds no pose.
std::vector<PoseTrack::Stamped> read_tum(const std::filesystem::path& path);

/// Nine decimals of stamps and positions, twelve of quaternions.
std::string tum_text(const std::vector<PoseTrack::Stamped>& poses);

}  // namespace plumbline
