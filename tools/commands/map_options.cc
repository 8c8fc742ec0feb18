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

Pose start_of(const MapArguments& arguments, const SitedMap& map, const std::optional<Pose>& site_from_start) {
  if (arguments.start.empty()) {
    if (!map.site_from_map || !site_from_start) return {};
    // Level on its site, as odometry begins level, whichever way the map leans.
    const Eigen::Vector3d yaw{0.0, 0.0, rpy_from_rotation(site_from_start->rotation).z()};
    return map.site_from_map->inverse() * Pose{rotation_from_rpy(yaw), site_from_start->translation};
  }
  const auto& s = arguments.start;
  return {rotation_from_rpy({0.0, 0.0, s[3] * std::numbers::pi / 180.0}), {s[0], s[1], s[2]}};
}

std::string corner_text(const Eigen::Vector3d& corner) {
  return "(" + readable_text(corner.x()) + ", " + readable_text(corner.y()) + ", " + readable_text(corner.z()) + ")";
}

void check_start(const std::string& path, const PriorMap& map, const Eigen::Vector3d& start, double reach_m) {
  const double distance_m = map.distance(start);
  if (distance_m > reach_m) {
    throw InputError((path.empty() ? "the survey's map" : path) + ": its nearest surface is " +
                     readable_text(distance_m) + " m from the start " + corner_text(start) + ", beyond the lidar's " +
                     readable_text(reach_m) + " m; it spans " + corner_text(map.low) + " to " + corner_text(map.high) +
                     ". Is it in metres, and --map-start where the run begins on it?");
  }
}

}  // namespace

void add_map_options(CLI::App& verb, MapArguments& arguments) {
  CLI::Option* map = verb.add_option("--map", arguments.map, "localize on this map (PLY or PCD, metres, z up)");
  verb.add_option("--map-start", arguments.start,
                  "X Y Z YAW_DEG: where the run begins on the map; by default where a simulated run does on a map that "
                  "says where it lies on its site, otherwise 0 0 0 0")
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

std::optional<SitedMap> map_of(const MapArguments& arguments) {
  if (arguments.map.empty()) return std::nullopt;
  return read_prior_map(arguments.map);
}

std::unique_ptr<Estimator> localize(std::unique_ptr<Estimator> odometry, const SitedMap& map,
                                    const MapArguments& arguments, const Calibration& calibration,
                                    const EstimatorConfig& config, const std::optional<Pose>& site_from_start) {
  if (!calibration.has_lidar) throw InputError("localization on a map: there is no lidar to match it with");
  LocalizationConfig localization;
  if (arguments.localizer == "particle_filter") localization.method = LocalizationMethod::kParticleFilter;
  localization.rate_hz = arguments.rate_hz;
  localization.map_from_start = start_of(arguments, map, site_from_start);
  localization.remapping = config.remapping;
  check_start(arguments.map, map.map, localization.map_from_start.translation, calibration.lidar_max_range_m);
  return std::make_unique<LocalizedEstimator>(std::move(odometry), calibration, map.map, localization);
}

}  // namespace plumbline
