#pragma once

#include <vector>

#include "estimator/lidar/features.h"
#include "estimator/localization/occupancy.h"

namespace plumbline {

/// The planes that a pose has near a map, and so should find there.
std::vector<FeaturePoint> planes_near(const std::vector<FeaturePoint>& planes, const Occupancy& map,
                                      const Pose& map_from_body);

/// [rad] Normals of rough ground that beams graze scatter by so much. Their scatter alone would look like knowledge of
/// where on a plain the sensor is.
inline constexpr double kNormalSigma = 0.1;

/// J^T J about the body's pose of planes that all lie on a map, less what scatter of their normals adds to it.
Matrix6d plane_information(const std::vector<FeaturePoint>& planes_in_body, double sigma_m, double normal_sigma);

/// Of what planes would tell if all lay on the map, the share that the map bears out, along the direction where that is
/// least. At a wrong place floor and walls may well fit, but what would tell one place along them from another does
/// not.
/// @param expected   by plane_information(); directions in which that is below the threshold do not count
/// @param borne_out  J^T J of what was found on the map, robust weights included
double map_support(const Matrix6d& expected, const Matrix6d& borne_out, double degeneracy_threshold);

}  // namespace plumbline
