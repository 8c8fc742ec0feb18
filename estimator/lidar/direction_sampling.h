#pragma once

#include <cstdint>
#include <vector>

#include "estimator/lidar/features.h"

namespace plumbline {

/// Picks at most `budget` planar features, as evenly over the directions they face as the scan allows, in their order.
/// In a tunnel nearly all returns lie on its walls; the few that face along it decide that direction, and an even
/// choice over space would throw most of them away.
std::vector<std::uint32_t> sample_by_direction(const std::vector<FeaturePoint>& planes, int budget);

}  // namespace plumbline
