#pragma once

#include <optional>
#include <vector>

#include "tools/evaluation/pairing.h"

namespace plumbline {

/// The KITTI odometry benchmark's errors: means over segments that start every second and are 100, 200 … 800 m long, or
/// 1/8 … 8/8 of the path where that is shorter than 800 m.
struct KittiError {
  std::optional<double> translation_percent;
  std::optional<double> rotation_deg_per_m;
  bool scaled = false;  ///< lengths followed the path
};

/// Blind to alignment. @param distance_m  the true path's length
KittiError kitti_error(const std::vector<PosePair>& pairs, double distance_m);

}  // namespace plumbline
