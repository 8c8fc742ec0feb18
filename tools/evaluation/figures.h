#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/run_record.h"
#include "tools/evaluation/alignment.h"
#include "tools/evaluation/flight_figures.h"
#include "tools/evaluation/kitti.h"
#include "tools/evaluation/localization_figures.h"
#include "tools/evaluation/map_error.h"
#include "tools/evaluation/module_figures.h"
#include "tools/evaluation/progress.h"
#include "tools/evaluation/trajectory_error.h"

namespace plumbline {

/// What a truth and an estimate say about each other.
struct TrajectoryFigures {
  bool has_truth = false;   ///< without one nothing else is known
  double duration_s = 0.0;  ///< of the truth
  double distance_m = 0.0;  ///< of the truth
  std::optional<double> final_error_m;
  std::optional<double> final_error_deg;
  std::optional<double> max_error_m;
  std::optional<double> drift_percent;
  ProgressRatio progress;
  KittiError kitti;
  std::optional<RootMeanSquare> ape;
  std::optional<RootMeanSquare> rpe;
  std::vector<RootMeanSquare> rpe_by_second;  ///< see relative_error_by_second()
  std::optional<double>
      lost_since_s;  ///< since then the position error stays above 1 m + 10 % of the distance travelled

  Alignment drift_alignment;      ///< what drift and everything drawn were aligned by
  std::vector<PosePair> aligned;  ///< with drift_alignment, to the truth's end
};

/// @param alignment   of every error; without one drift, progress and the like follow the first second, ape follows se3
/// @param settled_ns  the second from then on is meant instead: an estimate that is put on a prior map changes its
/// frame
TrajectoryFigures trajectory_figures(const StampedPoses& truth, const StampedPoses& estimate,
                                     std::optional<AlignmentKind> alignment = std::nullopt,
                                     std::optional<std::int64_t> settled_ns = std::nullopt);

/// All that a run is judged by.
struct RunFigures {
  TrajectoryFigures trajectory;
  MapError map;
  double simulated_s = 0.0;  ///< the truth's duration, or the estimate's where there is no truth
  std::size_t map_points = 0;
  std::optional<double> nees_mean;
  std::optional<double> estimator_real_time_factor;
  std::optional<double> real_time_factor;           ///< filled in last, when the outputs are written
  std::optional<double> wall_s;                     ///< likewise
  std::optional<LocalizationFigures> localization;  ///< with a prior map
  std::optional<FlightFigures> flight;              ///< in closed loop
  std::map<Module, ModuleFigures> modules;
  std::map<Module, MessageTally> messages;
};

/// @param distance_to_surface  null where the world is not known
RunFigures run_figures(const RunRecord& record,
                       const std::function<double(const Eigen::Vector3d&)>& distance_to_surface);

/// One number of result.json under its key; dots lead into nested objects.
struct Figure {
  std::string key;
  std::optional<double> value;  ///< finite
  bool is_count = false;
};

std::vector<Figure> figure_list(const TrajectoryFigures& figures);
/// Those of the trajectory and all others.
std::vector<Figure> figure_list(const RunFigures& figures);

/// How result.json calls a module's messages: imu, camera, lidar.
std::string message_key(Module module);
constexpr Module kModules[] = {Module::kImu, Module::kVision, Module::kLidar};

}  // namespace plumbline
