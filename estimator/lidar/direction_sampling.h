#pragma once

#include <cstdint>
#include <vector>

#include "estimator/lidar/features.h"

namespace plumbline {

/// Picks at most `budget` planar features, as evenly over the directions they face as the scan allows, in their order.
/// In a tunnel nearly all returns lie on its walls; the few that face along it decide that direction, and an even
/// choice over space would throw most of them away. Half the budget is spent evenly over the scan all the same: foliage
/// faces every way, seldom makes a plane, and would leave little of the budget to the ground.
std::vector<std::uint32_t> sample_by_direction(const std::vector<FeaturePoint>& planes, int budget);

/// Picks at most `budget` features evenly along their order.
std::vector<FeaturePoint> every_nth(const std::vector<FeaturePoint>& features, int budget);
/// Those at the given places.
std::vector<FeaturePoint> pick(const std::vector<FeaturePoint>& features, const std::vector<std::uint32_t>& which);

}  // namespace plumbline
