#pragma once

#include <cstdint>
#include <vector>

#include "estimator/estimator.h"

namespace plumbline {

/// Two maps in one frame from above and from the side, as a PNG's bytes: A blue, B orange, green where both are.
std::vector<std::uint8_t> merge_picture(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b);

}  // namespace plumbline
