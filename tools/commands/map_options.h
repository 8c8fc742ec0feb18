#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/localization/prior_map.h"

namespace plumbline {

/// --map and what goes with it.
struct MapArguments {
  std::string map;            ///< empty: no localization
  std::vector<double> start;  ///< x, y, z [m] and yaw [deg] of odometry's start on the map; empty: all zero
  std::string localizer = "matcher";
  double rate_hz = 0.5;
};

void add_map_options(CLI::App& verb, MapArguments& arguments);

/// An odometry localized on the map that was asked for, or as it was where none was. @throws InputError for a map that
/// cannot be used, or that has nothing within the lidar's reach of the start
std::unique_ptr<Estimator> localize(std::unique_ptr<Estimator> odometry, const MapArguments& arguments,
                                    const Calibration& calibration, const EstimatorConfig& config);

}  // namespace plumbline
