#include "tools/commands/map_options.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/localization/localized_estimator.h"
#include "scenarios/input_error.h"
#include "tools/formats/number_text.h"
#include "tools/formats/point_cloud_file.h"

namespace plumbline {
namespace {

constexpr double kLeastRate_hz = 0.1;
constexpr double kMostRate_hz = 20.0;

Pose start_of(const MapArguments& arguments) {
  if (arguments.start.empty()) return {};
  const auto& s = arguments.start;
  return {rotation_from_rpy({0.0, 0.0, s[3] * std::numbers::pi / 180.0}), {s[0], s[1], s[2]}};
}

std::string corner_text(const Eigen::Vector3d& corner) {
  return "(" + readable_text(corner.x()) + ", " + readable_text(corner.y()) + ", " + readable_text(corner.z()) + ")";
}

PriorMap map_around(const std::string& path, const Eigen::Vector3d& start, double reach_m) {
  PriorMap map = read_prior_map(path).map;
  const double distance_m = map.distance(start);
  if (distance_m > reach_m) {
    throw InputError(path + ": its nearest surface is " + readable_text(distance_m) + " m from the start " +
                     corner_text(start) + ", beyond the lidar's " + readable_text(reach_m) + " m; it spans " +
                     corner_text(map.low) + " to " + corner_text(map.high) +
                     ". Is it in metres, and --map-start where the run begins on it?");
  }
  return map;
}

}  // namespace

void add_map_options(CLI::App& verb, MapArguments& arguments) {
  CLI::Option* map = verb.add_option("--map", arguments.map, "localize on this map (PLY or PCD, metres, z up)");
  verb.add_option("--map-start", arguments.start, "X Y Z YAW_DEG: where the run begins on the map; 0 0 0 0 by default")
      ->expected(4)
      ->check(CLI::Range(-1e4, 1e4))
      ->needs(map);
  verb.add_option("--localizer", arguments.localizer, "matcher, or the baseline, particle_filter")
      ->check(CLI::IsMember({"matcher", "particle_filter"}))
      ->needs(map);
  verb.add_option("--map-rate", arguments.rate_hz, "matches with the map a second [Hz]; scans are stacked in between")
      ->check(CLI::Range(kLeastRate_hz, kMostRate_hz))
      ->capture_default_str()
      ->needs(map);
}

std::unique_ptr<Estimator> localize(std::unique_ptr<Estimator> odometry, const MapArguments& arguments,
                                    const Calibration& calibration, const EstimatorConfig& config) {
  if (arguments.map.empty()) return odometry;
  if (!calibration.has_lidar) throw InputError(arguments.map + ": there is no lidar to match the map with");
  LocalizationConfig localization;
  if (arguments.localizer == "particle_filter") localization.method = LocalizationMethod::kParticleFilter;
  localization.rate_hz = arguments.rate_hz;
  localization.map_from_start = start_of(arguments);
  localization.remapping = config.remapping;
  const PriorMap map =
      map_around(arguments.map, localization.map_from_start.translation, calibration.lidar_max_range_m);
  return std::make_unique<LocalizedEstimator>(std::move(odometry), calibration, map, localization);
}

}  // namespace plumbline
