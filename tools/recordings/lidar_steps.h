#pragma once

#include <filesystem>

#include "tools/recordings/check_row.h"

/// Lidar odometry on KITTI's scans, loose in a folder, without an IMU.
namespace plumbline {

/// Raw scans and icp_relative_check.txt, rows "scan tx ty tz yaw_deg …": how far each scan lies from the one before it,
/// by a careful registration. Each step's x and y are to come within 3 cm, its yaw within 0.1 degrees.
bool has_raw_steps(const std::filesystem::path& folder);
CheckRows check_raw_steps(const std::filesystem::path& folder);

/// Motion-compensated scans, gt_cam_poses*.txt of a row for each, and calib_Tr.txt. Each step is to come within 2 cm
/// and 0.05 degrees of the truth.
bool has_odometry_pairs(const std::filesystem::path& folder);
CheckRows check_odometry_pairs(const std::filesystem::path& folder);

}  // namespace plumbline
