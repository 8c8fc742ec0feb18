#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"

namespace plumbline {

/// "KEY: numbers" lines, as in all of KITTI's calibration files; lines whose values are no numbers are left out.
/// @throws InputError if the file cannot be read
std::map<std::string, std::vector<double>> read_kitti_keys(const std::filesystem::path& path);

/// A rigid transform from twelve numbers, the upper three rows of its matrix; the rotation is brought to SO(3).
/// @throws InputError unless it is one, to a per cent
Pose kitti_pose(const std::vector<double>& rows, const std::string& where);

/// Twelve numbers.
std::string kitti_pose_text(const Pose& pose);

}  // namespace plumbline
