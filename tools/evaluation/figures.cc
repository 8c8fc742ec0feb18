#include "tools/evaluation/figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/geometry/so3.h"
#include "tools/evaluation/consistency.h"

namespace plumbline {
namespace {

constexpr double kLostFloor = 1.0;  // [m]
constexpr double kLostShare = 0.1;  // of the distance travelled

double rotation_error_deg(const PosePair& pair) {
  return log_so3(pair.truth.rotation.conjugate() * pair.estimate.rotation).norm() * 180.0 / std::numbers::pi;
}

double position_error(const PosePair& pair) { return (pair.estimate.translation - pair.truth.translation).norm(); }

std::optional<double> lost_since(const std::vector<PosePair>& aligned_pairs) {
  const std::vector<double> distance = distance_along(aligned_pairs);
  std::size_t first = aligned_pairs.size();
  while (first > 0) {
    // Written so that an error that is no number counts as lost.
    const bool near = position_error(aligned_pairs[first - 1]) <= kLostFloor + kLostShare * distance[first - 1];
    if (near) break;
    --first;
  }
  if (first == aligned_pairs.size()) return std::nullopt;
  return seconds_between(aligned_pairs.front().stamp_ns, aligned_pairs[first].stamp_ns);
}

std::vector<PosePair> moved_by(const Alignment& alignment, std::vector<PosePair> pairs) {
  for (PosePair& pair : pairs) pair.estimate = alignment.apply(pair.estimate);
  return pairs;
}

double duration_s(const StampedPoses& poses) {
  return poses.empty() ? 0.0 : seconds_between(poses.front().stamp_ns, poses.back().stamp_ns);
}

std::optional<double> finite(std::optional<double> value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

void append_localization(std::vector<Figure>& list, const LocalizationFigures& localization) {
  const std::string prefix = "localization.";
  list.push_back({prefix + "matches", static_cast<double>(localization.matches), true});
  list.push_back({prefix + "share", finite(localization.share)});
  list.push_back({prefix + "first_s", finite(localization.first_s)});
  list.push_back({prefix + "error_median_m", finite(localization.error_median_m)});
  list.push_back({prefix + "error_p75_m", finite(localization.error_p75_m)});
  list.push_back({prefix + "error_max_m", finite(localization.error_max_m)});
  list.push_back({prefix + "overlap_median", finite(localization.overlap_median)});
  list.push_back({prefix + "support_median", finite(localization.support_median)});
  list.push_back({prefix + "correction_median_m", finite(localization.correction_median_m)});
  list.push_back({prefix + "iterations_median", finite(localization.iterations_median)});
  list.push_back({prefix + "mean_ms", finite(localization.mean_ms)});
  list.push_back({prefix + "ms_per_s", finite(localization.ms_per_s)});
}

void append_flight(std::vector<Figure>& list, const FlightFigures& flight) {
  list.push_back({"waypoints", static_cast<double>(flight.waypoints), true});
  list.push_back({"waypoints_missed", static_cast<double>(flight.waypoints_missed), true});
  list.push_back({"collisions", static_cast<double>(flight.collisions), true});
  list.push_back({"clearance_min_m", finite(flight.clearance_min_m)});
  list.push_back({"tracking_error_rms_m", finite(flight.tracking_error_rms_m)});
  list.push_back({"tracking_error_max_m", finite(flight.tracking_error_max_m)});
  list.push_back({"estimate_error_max_m", finite(flight.estimate_error_max_m)});
  list.push_back({"control_error_max_m", finite(flight.control_error_max_m)});
  list.push_back({"failure_since_s", finite(flight.failure_since_s)});
}

std::optional<double> translation_of(const std::optional<RootMeanSquare>& error) {
  return error ? std::optional(error->translation_m) : std::nullopt;
}

std::optional<double> rotation_of(const std::optional<RootMeanSquare>& error) {
  return error ? std::optional(error->rotation_deg) : std::nullopt;
}

void append_module(std::vector<Figure>& list, const std::string& key, const ModuleFigures& module) {
  const std::string prefix = "modules." + key + ".";
  list.push_back({prefix + "calls", static_cast<double>(module.calls), true});
  list.push_back({prefix + "mean_ms", finite(module.mean_ms)});
  list.push_back({prefix + "p50_ms", finite(module.p50_ms)});
  list.push_back({prefix + "p95_ms", finite(module.p95_ms)});
  list.push_back({prefix + "max_ms", finite(module.max_ms)});
  list.push_back({prefix + "degenerate_share", finite(module.degenerate_share)});
  list.push_back({prefix + "nees_degenerate", finite(module.nees_degenerate)});
}

void append_messages(std::vector<Figure>& list, const std::string& key, const MessageTally& tally) {
  list.push_back({"messages." + key + ".produced", static_cast<double>(tally.produced), true});
  list.push_back({"messages." + key + ".used", static_cast<double>(tally.used), true});
}

/// The pairs from a time on; all of them if there are none.
std::vector<PosePair> settled(std::vector<PosePair> pairs, std::optional<std::int64_t> from_ns) {
  if (!from_ns || pairs.back().stamp_ns < *from_ns) return pairs;
  std::erase_if(pairs, [&](const PosePair& pair) { return pair.stamp_ns < *from_ns; });
  return pairs;
}

}  // namespace

TrajectoryFigures trajectory_figures(const StampedPoses& truth, const StampedPoses& estimate,
                                     std::optional<AlignmentKind> alignment, std::optional<std::int64_t> settled_ns) {
  TrajectoryFigures figures;
  figures.has_truth = !truth.empty();
  figures.duration_s = duration_s(truth);
  figures.distance_m = path_length_m(truth);

  const std::vector<PosePair> pairs = pair_poses_to_end(truth, estimate);
  if (pairs.empty()) return figures;
  figures.drift_alignment =
      alignment ? align(pairs, *alignment) : Alignment{align_first_second(settled(pairs, settled_ns)), 1.0};
  figures.aligned = moved_by(figures.drift_alignment, pairs);
  figures.final_error_m = position_error(figures.aligned.back());
  figures.final_error_deg = rotation_error_deg(figures.aligned.back());
  const auto worst = std::max_element(figures.aligned.begin(), figures.aligned.end(), [](const auto& a, const auto& b) {
    return position_error(a) < position_error(b);
  });
  figures.max_error_m = position_error(*worst);
  figures.drift_percent = drift_percent(figures.aligned, figures.distance_m);
  figures.progress = progress_ratio(figures.aligned);
  figures.lost_since_s = lost_since(figures.aligned);
  // Relative figures are blind to alignment but for a scale, which the aligned estimate already has.
  figures.kitti = kitti_error(figures.aligned, figures.distance_m);
  figures.rpe = relative_error(figures.aligned);
  figures.rpe_by_second = relative_error_by_second(figures.aligned);
  figures.ape = absolute_error(moved_by(align(pairs, alignment.value_or(AlignmentKind::kSe3)), pairs));
  return figures;
}

RunFigures run_figures(const RunRecord& record,
                       const std::function<double(const Eigen::Vector3d&)>& distance_to_surface) {
  RunFigures figures;
  figures.localization = localization_figures(record);
  figures.trajectory = trajectory_figures(record.ground_truth, record.estimate, std::nullopt,
                                          figures.localization ? figures.localization->settled_ns : std::nullopt);
  figures.flight = flight_figures(record);
  figures.simulated_s = figures.trajectory.has_truth ? figures.trajectory.duration_s : duration_s(record.estimate);
  figures.map = map_error(record.map, figures.trajectory.drift_alignment.truth_from_estimate, distance_to_surface);
  figures.map_points = record.map.size();
  const std::vector<IncrementError> increments = increment_errors(record.odometry, record.ground_truth);
  figures.nees_mean = nees_mean(increments);
  if (record.estimator_wall_s > 0.0) {
    figures.estimator_real_time_factor = figures.simulated_s / record.estimator_wall_s;
  }
  for (const Module module : kModules) {
    figures.modules[module] = module_figures(record, module);
    figures.modules[module].nees_degenerate = nees_degenerate(increments, record.health, module);
    const auto tally = record.messages.find(module);
    figures.messages[module] = tally == record.messages.end() ? MessageTally{} : tally->second;
  }
  return figures;
}

std::vector<Figure> figure_list(const TrajectoryFigures& figures) {
  return {
      {"duration_s", figures.has_truth ? finite(figures.duration_s) : std::nullopt},
      {"distance_m", figures.has_truth ? finite(figures.distance_m) : std::nullopt},
      {"drift_percent", finite(figures.drift_percent)},
      {"progress_ratio", finite(figures.progress.whole)},
      {"progress_ratio_worst_5s", finite(figures.progress.worst_5s)},
      {"kitti_translation_percent", finite(figures.kitti.translation_percent)},
      {"kitti_rotation_deg_per_m", finite(figures.kitti.rotation_deg_per_m)},
      {"ape_rmse_m", finite(translation_of(figures.ape))},
      {"ape_rmse_deg", finite(rotation_of(figures.ape))},
      {"rpe_rmse_m", finite(translation_of(figures.rpe))},
      {"rpe_rmse_deg", finite(rotation_of(figures.rpe))},
      {"final_error_m", finite(figures.final_error_m)},
      {"final_error_deg", finite(figures.final_error_deg)},
      {"max_error_m", finite(figures.max_error_m)},
      {"lost_since_s", finite(figures.lost_since_s)},
  };
}

std::vector<Figure> figure_list(const RunFigures& figures) {
  std::vector<Figure> list = figure_list(figures.trajectory);
  list.push_back({"map_rmse_m", finite(figures.map.rmse_m)});
  list.push_back({"map_p95_m", finite(figures.map.p95_m)});
  list.push_back({"map_points", static_cast<double>(figures.map_points), true});
  list.push_back({"nees_mean", finite(figures.nees_mean)});
  list.push_back({"real_time_factor", finite(figures.real_time_factor)});
  list.push_back({"estimator_real_time_factor", finite(figures.estimator_real_time_factor)});
  list.push_back({"wall_s", finite(figures.wall_s)});
  if (figures.flight) append_flight(list, *figures.flight);
  if (figures.localization) append_localization(list, *figures.localization);
  for (const Module module : kModules) {
    const auto found = figures.modules.find(module);
    append_module(list, std::string(to_string(module)),
                  found == figures.modules.end() ? ModuleFigures{} : found->second);
  }
  for (const Module module : kModules) {
    const auto found = figures.messages.find(module);
    append_messages(list, message_key(module), found == figures.messages.end() ? MessageTally{} : found->second);
  }
  return list;
}

std::string message_key(Module module) { return module == Module::kVision ? "camera" : std::string(to_string(module)); }

}  // namespace plumbline
