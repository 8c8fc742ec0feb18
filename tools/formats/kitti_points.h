#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/messages.h"

/// Points as KITTI keeps them: no times, no rings, ring by ring from the top, each ring from straight ahead round to
/// the left.
namespace plumbline {

/// A .bin (x, y, z, intensity as float32) or a .pcd (see read_point_cloud(); the intensity may be missing), of at most
/// 8 million points. Times and rings are left at 0. @throws InputError
std::vector<LidarPoint> read_kitti_points(const std::filesystem::path& path);

/// Drops points that are not finite, beyond 10 km or at the origin.
void drop_unusable(std::vector<LidarPoint>& points);

/// Numbers the rings by counting how often the azimuth starts anew, the top one `rings` - 1. Points of a ring beyond
/// that many are dropped.
void assign_rings_by_azimuth(int rings, std::vector<LidarPoint>& points);

/// A head that turns clockwise seen from above and starts at the rear: t = duration (180 deg - azimuth) / 360 deg.
void assign_times_by_azimuth(std::int64_t duration_ns, std::vector<LidarPoint>& points);

/// Brings points into firing order; at one time those of lower rings come first.
void sort_by_time(std::vector<LidarPoint>& points);

/// Brings points into a KITTI file's order.
void sort_as_kitti(std::vector<LidarPoint>& points);

/// The bytes of a .bin.
std::string kitti_bin(const std::vector<LidarPoint>& points);

}  // namespace plumbline
