#pragma once

#include <optional>

#include "estimator/lidar/ring_table.h"

namespace plumbline {

/// Where the axis of a thin upright thing, a trunk or a post, stands behind a run of returns.
struct Pole {
  int index = 0;               ///< of the run's middle return
  Eigen::Vector3f axis_point;  ///< in B
  float spread_m = 0.0F;       ///< one sigma, since either border lies anywhere between two beams
};

/// The run [first, end) of a ring as a pole: narrow, convex enough to be seen alike from all sides, and in front of
/// nothing, or of what is further off, on both sides. Where a border is depends on where it is seen from; the middle
/// between both does not.
std::optional<Pole> pole_of_run(const RingTable& table, int ring, int first, int end, float range_sigma);

}  // namespace plumbline
