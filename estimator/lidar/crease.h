#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/lidar/ring_table.h"

namespace plumbline {

/// Where the returns [i - half_window, i + half_window] of one run, taken as two straight lines, cross: the edge
/// itself, to a fraction of the noise of one return. None where two lines do not explain the returns or hardly turn: a
/// rough surface has curvature (5.12) but no edge. Of a trunk or a post, whose returns a circle explains better, the
/// circle's centre: where the nearest side of something round lies depends on where it is seen from.
std::optional<Eigen::Vector3f> fit_crease(const RingTable& table, int i, int half_window, float range_sigma);

/// Whether the returns [i - half_window, i + half_window] of one run bend roundly: a circle explains them better than
/// a straight line and than two. Of a surface that turns away so, the border seen is none of its own.
bool is_round(const RingTable& table, int i, int half_window);

}  // namespace plumbline
