#include "tools/output/summary.h"

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr std::size_t kNameWidth = 12;

std::string row(std::string name, const std::string& text) {
  name.resize(kNameWidth, ' ');
  return std::string(2, ' ').append(name).append(text).append("\n");
}

/// "0.310 %", or a dash for a figure that the run could not give.
std::string with_unit(const std::optional<double>& value, const std::string& unit) {
  return value ? readable_text(*value) + unit : "–";
}

std::string error_row(const std::string& name, const std::optional<RootMeanSquare>& error) {
  return row(name,
             error ? readable_text(error->translation_m) + " m, " + readable_text(error->rotation_deg) + "° rms" : "–");
}

std::string module_row(Module module, const ModuleFigures& figures) {
  std::string text = std::to_string(figures.calls) + " calls, mean " + with_unit(figures.mean_ms, " ms") + ", p95 " +
                     with_unit(figures.p95_ms, " ms");
  if (figures.degenerate_share) text += ", degenerate " + readable_text(100.0 * *figures.degenerate_share) + " %";
  if (figures.nees_degenerate) text += ", NEES there " + readable_text(*figures.nees_degenerate);
  return row(std::string(to_string(module)), text);
}

std::string localization_row(const LocalizationFigures& figures) {
  std::string text = figures.at_end ? "at the end, " : "not at the end, ";
  text += with_unit(figures.share ? std::optional(100.0 * *figures.share) : std::nullopt, " % of the time, error ") +
          with_unit(figures.error_median_m, " m median, ") + with_unit(figures.error_max_m, " m worst; matches:");
  for (const auto& [outcome, count] : figures.outcomes) text += " " + std::to_string(count) + " " + outcome + ",";
  return row("localized", text + " " + with_unit(figures.mean_ms, " ms each"));
}

std::string flight_row(const FlightFigures& figures) {
  std::string text =
      to_string(figures.end) + ", " + std::to_string(figures.waypoints - figures.waypoints_missed) + " of " +
      std::to_string(figures.waypoints) + " way-points, clearance " + with_unit(figures.clearance_min_m, " m") +
      "; worst errors: tracking " + with_unit(figures.tracking_error_max_m, " m, estimate ") +
      with_unit(figures.estimate_error_max_m, " m, control ") + with_unit(figures.control_error_max_m, " m");
  if (figures.origin != FailureOrigin::kNone) {
    text += "; the failure began in " + to_string(figures.origin) + ", " + with_unit(figures.failure_since_s, " s");
  }
  return row("flight", text);
}

std::string problems(const RunRecord& record, const RunFigures& figures, const Verdict& verdict) {
  std::string text;
  if (!record.fault.empty()) text += row("fault", record.fault);
  if (record.estimator_lost) text += row("lost", "the estimator says so");
  if (figures.trajectory.lost_since_s) {
    text += row("lost", "since " + readable_text(*figures.trajectory.lost_since_s) +
                            " s the error exceeds 1 m + 10 % of the distance");
  }
  for (const Check& check : verdict.checks) {
    if (!check.holds) text += row("broken", describe(check));
  }
  if (verdict.expected_status && *verdict.expected_status != to_string(verdict.status)) {
    text += row("broken", "status = " + to_string(verdict.status) + ", expected " + *verdict.expected_status);
  }
  return text;
}

}  // namespace

std::string trajectory_summary(const TrajectoryFigures& figures) {
  return row("truth", readable_text(figures.distance_m) + " m in " + readable_text(figures.duration_s) + " s") +
         row("drift",
             with_unit(figures.drift_percent, " %") + ", " + with_unit(figures.final_error_m, " m at the end")) +
         row("progress",
             with_unit(figures.progress.whole, "") + ", worst 5 s " + with_unit(figures.progress.worst_5s, "")) +
         row("kitti", with_unit(figures.kitti.translation_percent, " %") + ", " +
                          with_unit(figures.kitti.rotation_deg_per_m, " deg/m") +
                          (figures.kitti.scaled ? " (over eighths of the path)" : "")) +
         error_row("absolute", figures.ape) + error_row("over 1 s", figures.rpe);
}

std::string run_summary(const RunRecord& record, const RunFigures& figures, const Verdict& verdict) {
  std::string text = trajectory_summary(figures.trajectory);
  text += row("map", with_unit(figures.map.rmse_m, " m rms") + ", p95 " + with_unit(figures.map.p95_m, " m") + ", " +
                         std::to_string(figures.map_points) + " points");
  for (const auto& [module, module_figures] : figures.modules) text += module_row(module, module_figures);
  if (figures.flight) text += flight_row(*figures.flight);
  if (figures.localization) text += localization_row(*figures.localization);
  text += row("speed", with_unit(figures.real_time_factor, " × real time") + ", the estimator alone " +
                           with_unit(figures.estimator_real_time_factor, " ×"));
  return text + problems(record, figures, verdict);
}

}  // namespace plumbline
