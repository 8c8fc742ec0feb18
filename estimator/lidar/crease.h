#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/lidar/ring_table.h"

namespace plumbline {

/// Where the returns [i - half_window, i + half_window] of one run, taken as two straight lines, cross: the edge
/// itself, to a fraction of the noise of one return. None where two lines do not explain the returns or hardly turn: a
/// round or a rough surface has curvature (5.12) but no edge.
std::optional<Eigen::Vector3f> fit_crease(const RingTable& table, int i, int half_window, float range_sigma);

}  // namespace plumbline
