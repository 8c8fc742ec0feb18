#pragma once

#include "sensors/lidar_model.h"

namespace plumbline {

/// A noise-free scan of a hall of 36 m by 28 m, spun by hand at 370 degrees per second about a wandering axis: how far
/// its points are from the hall's surfaces.
struct DeskewCheck {
  std::size_t points = 0;
  double worst_m = 0.0;           ///< de-skewed with the true path
  double raw_percentile_m = 0.0;  ///< the 95th percentile with the pose at the message's start for all
};
DeskewCheck check_deskew(const LidarModel& device);

}  // namespace plumbline
