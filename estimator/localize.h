#pragma once

#include <memory>
#include <vector>

#include "estimator/estimator.h"

namespace plumbline {

/// Puts an odometry on a map made earlier: its outputs are then world_from_body in the map's frame, and
/// Odometry::localized and map_matches say how well they go together (see estimator/localization/).
/// @param map             points in metres, z up; with normals, zero at edges, or with none at all
/// @param map_from_start  where the odometry begins on the map, to a metre and ten degrees
/// @throws std::invalid_argument for a map without usable points, or a calibration without a lidar
std::unique_ptr<Estimator> make_localized_estimator(std::unique_ptr<Estimator> odometry, const Calibration& calibration,
                                                    const std::vector<MapPoint>& map, const Pose& map_from_start);

}  // namespace plumbline
