#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimator/geometry/interpolation.h"

/// Trajectories as the TUM RGB-D benchmark writes them: "stamp_s x y z qx qy qz qw" a line, '#' comments.
namespace plumbline {

/// sim/tum_file.h's reader. @throws InputError with its message.
std::vector<PoseTrack::Stamped> read_tum(const std::filesystem::path& path);

/// Nine decimals of stamps and positions, twelve of quaternions.
std::string tum_text(const std::vector<PoseTrack::Stamped>& poses);

}  // namespace plumbline
