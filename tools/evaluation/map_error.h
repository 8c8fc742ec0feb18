#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "estimator/estimator.h"

namespace plumbline {

/// Distances of mapped points to the true surfaces.
struct MapError {
  std::optional<double> rmse_m;
  std::optional<double> p95_m;
};

/// A point further from every surface than this counts as this far [m].
constexpr double kMapErrorLimit = 5.0;

/// @param distance_to_surface  of a point in the true world, at most kMapErrorLimit
/// Takes at most 20,000 points, evenly spread over the map's fixed order.
MapError map_error(const std::vector<MapPoint>& map, const Pose& truth_from_estimate,
                   const std::function<double(const Eigen::Vector3d&)>& distance_to_surface);

}  // namespace plumbline
