#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "tools/formats/point_cloud_file.h"

namespace plumbline {

/// --map and what goes with it.
struct MapArguments {
  std::string map;            ///< empty: no localization
  std::vector<double> start;  ///< x, y, z [m] and yaw [deg] of odometry's start on the map; empty: all zero
  std::string localizer = "matcher";
  double rate_hz = 0.5;
};

void add_map_options(CLI::App& verb, MapArguments& arguments);

/// The map that was asked for, if one was. @throws InputError
std::optional<SitedMap> map_of(const MapArguments& arguments);

/// An odometry localized on a map. @throws InputError if that has nothing within the lidar's reach of the start
/// @param site_from_start  where the run begins, if that is known: without --map-start it tells where on a map that
/// knows
///                         its site
std::unique_ptr<Estimator> localize(std::unique_ptr<Estimator> odometry, const SitedMap& map,
                                    const MapArguments& arguments, const Calibration& calibration,
                                    const EstimatorConfig& config, const std::optional<Pose>& site_from_start = {});

}  // namespace plumbline
