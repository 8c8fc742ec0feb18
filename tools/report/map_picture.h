#pragma once

#include <string>

#include "scenarios/run_record.h"
#include "tools/evaluation/pairing.h"

namespace plumbline {

enum class MapView { kTop, kSide };

/// The map as a grey picture of its density with the true and estimated paths drawn over it, to scale, as a figure.
/// The longer of the world's x and y runs to the right; the side view looks across it with z up.
/// @param aligned  estimates in the truth's world, into which truth_from_estimate also brings the map
std::string map_picture(MapView view, const std::vector<PosePair>& aligned, const std::vector<MapPoint>& map,
                        const Pose& truth_from_estimate);

}  // namespace plumbline
