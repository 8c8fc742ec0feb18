#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace plumbline {

/// A lidar of the catalogue against its data sheet, whose figures are typed again in the source: when its beams fire
/// and where to, from the points alone, all of which return from a sphere.
struct FiringCheck {
  std::string device;
  double rate_hz = 0.0;
  double worst_time_ns = 0.0;
  double worst_angle_deg = 0.0;  ///< of elevation, azimuth or direction
  std::int64_t misplaced = 0;    ///< points of another ring, column or sweep than they must be
  std::int64_t points = 0;       ///< in a second, every firing counted
  std::int64_t expected_points = 0;
};

/// Every device at every rate that its sheet names.
std::vector<FiringCheck> check_lidar_firing();

}  // namespace plumbline
