#pragma once

#include <filesystem>

#include "tools/recordings/check_row.h"

namespace plumbline {

/// Corners of a board of markers as a stereo pair saw them, and the IMU: config.yaml (the cameras' models and
/// T_cam0_cam1), imu0.csv ("ts,wx,wy,wz,ax,ay,az") and cam0/ and cam1/ of a file per frame, named by its nanoseconds,
/// of rows "ts, rows, columns, size, spacing, pixel x, y, x, y, z on the board, marker, corner".
bool has_corner_tracks(const std::filesystem::path& folder);

/// The visual-inertial solver on the corners as features, their depth by stereo. The places of the corners on the board
/// serve the truth alone, which follows from them frame by frame. The drift is to be at most 1 %.
CheckRows check_corner_tracks(const std::filesystem::path& folder);

}  // namespace plumbline
