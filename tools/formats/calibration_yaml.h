#pragma once

#include <string>

#include "estimator/messages.h"

/// A Calibration as YAML text, which outside estimators, message streams and datasets carry.
///
/// Sections: imu; camera (camera 0) and lidar, each left out if there is none; further_cameras, a list. Every key has
/// its unit at its end; a transform is {translation_m: [x, y, z], quaternion_xyzw: [x, y, z, w]}; distortion is
/// [k1, k2, p1, p2]. All keys of a section must be there.
namespace plumbline {

constexpr int kCalibrationVersion = 1;

/// Numbers in the fewest digits that give the same number back. What a sensor that is not there holds is left out.
std::string calibration_yaml(const Calibration& calibration);

/// @param origin  the file's name, for messages
/// @throws InputError for anything missing, unknown, malformed or out of range, or another version
Calibration read_calibration_yaml(const std::string& text, const std::string& origin);

}  // namespace plumbline
