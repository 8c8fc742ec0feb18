#include "scenarios/figures.h"

namespace plumbline {

const std::vector<std::string>& result_figures() {
  static const std::vector<std::string> figures{
      "distance_m",
      "duration_s",
      "drift_percent",
      "progress_ratio",
      "progress_ratio_worst_5s",
      "kitti_translation_percent",
      "kitti_rotation_deg_per_m",
      "ape_rmse_m",
      "ape_rmse_deg",
      "rpe_rmse_m",
      "rpe_rmse_deg",
      "map_rmse_m",
      "map_p95_m",
      "nees_mean",
      "waypoints_missed",
      "collisions",
      "clearance_min_m",
      "tracking_error_rms_m",
      "tracking_error_max_m",
      "estimate_error_max_m",
      "control_error_max_m",
      "real_time_factor",
      "estimator_real_time_factor",
  };
  return figures;
}

}  // namespace plumbline
