#include "tools/report/run_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/geometry/so3.h"
#include "tools/formats/number_text.h"
#include "tools/report/svg_chart.h"

namespace plumbline {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
// Eigenvalues below this say the same as this one, and would squeeze the rest of their chart.
constexpr double kLeastEigenvalue = 1e-2;
// A status lasts until the module's next solve, but no longer than this: silence is shown as such.
constexpr double kLongestStatus = 0.5;  // [s]
constexpr double kSmallHeight = 118.0;

/// The poses that span the run's time.
const std::vector<PoseTrack::Stamped>& spanning(const RunRecord& record) {
  return record.ground_truth.empty() ? record.estimate : record.ground_truth;
}

ChartRange time_range(const RunRecord& record) {
  if (spanning(record).size() < 2) return {0.0, 1.0};
  return {0.0, seconds_between(start_of(record), spanning(record).back().stamp_ns)};
}

std::vector<ModuleHealth> solves_of(const RunRecord& record, Module module) {
  std::vector<ModuleHealth> solves;
  std::copy_if(record.health.begin(), record.health.end(), std::back_inserter(solves),
               [&](const ModuleHealth& row) { return row.module == module; });
  return solves;
}

std::vector<double> times_of(const std::vector<ModuleHealth>& rows, std::int64_t start_ns) {
  std::vector<double> times;
  for (const ModuleHealth& row : rows) times.push_back(seconds_between(start_ns, row.stamp_ns));
  return times;
}

std::string status_class(ModuleMode mode) {
  switch (mode) {
    case ModuleMode::kSolved:
      return "solved";
    case ModuleMode::kPartial:
      return "partial";
    case ModuleMode::kBypassed:
      break;
  }
  return "bypassed";
}

StripRow status_row(const std::string& label, const std::vector<ModuleHealth>& rows, std::int64_t start_ns) {
  StripRow strip{label, {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double from = seconds_between(start_ns, rows[i].stamp_ns);
    const double next = i + 1 < rows.size() ? seconds_between(start_ns, rows[i + 1].stamp_ns) : from + 0.1;
    strip.spans.push_back({from, std::min(next, from + kLongestStatus), status_class(rows[i].mode)});
  }
  return strip;
}

/// Zeros break the line: a module without data has no spectrum.
double shown_eigenvalue(const ModuleHealth& row, int i) {
  return row.eigenvalues[5] > 0.0 ? std::max(row.eigenvalues[i], kLeastEigenvalue) : kGap;
}

/// One axis of the corrections, in the unit that the chart shows.
std::string correction_chart(const std::vector<ModuleHealth>& rows, const RunRecord& record, int axis) {
  static constexpr std::array kNames = {"Roll", "Pitch", "Yaw", "Forward", "Left", "Up"};
  const bool rotation = axis < 3;
  ChartSeries line{"", "c0", times_of(rows, start_of(record)), {}};
  for (const ModuleHealth& row : rows) line.y.push_back(row.correction[axis] * (rotation ? kDegrees : 100.0));
  LineChart chart;
  chart.caption = kNames[static_cast<std::size_t>(axis)];
  chart.unit = rotation ? "deg" : "cm";
  chart.x = time_range(record);
  chart.height = kSmallHeight;
  chart.series = {line};
  return line_chart(chart);
}

/// Three components and, when asked for, their norm.
LineChart component_chart(std::string caption, std::string unit, const std::vector<double>& times,
                          const std::vector<Eigen::Vector3d>& values, const std::array<const char*, 3>& names,
                          bool with_norm) {
  LineChart chart;
  chart.caption = std::move(caption);
  chart.unit = std::move(unit);
  if (with_norm) {
    chart.series.push_back({"total", "estimate", times, {}});
    for (const auto& value : values) chart.series.back().y.push_back(value.norm());
  }
  static constexpr std::array kClasses = {"c0", "c1", "c2"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chart.series.push_back({names[axis], kClasses[axis], times, {}});
    for (const auto& value : values) chart.series.back().y.push_back(value[static_cast<Eigen::Index>(axis)]);
  }
  return chart;
}

}  // namespace

std::int64_t start_of(const RunRecord& record) {
  return spanning(record).empty() ? 0 : spanning(record).front().stamp_ns;
}

std::string error_charts(const RunRecord& record, const TrajectoryFigures& figures) {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Vector3d> attitude_deg;
  for (const PosePair& pair : figures.aligned) {
    times.push_back(seconds_between(start_of(record), pair.stamp_ns));
    const Vector6d error = pair.truth.local(pair.estimate);
    attitude_deg.emplace_back(kDegrees * error.head<3>());
    position.emplace_back(error.tail<3>());
  }
  LineChart position_chart = component_chart("Position error", "m", times, position, {"forward", "left", "up"}, true);
  LineChart attitude_chart =
      component_chart("Attitude error", "deg", times, attitude_deg, {"roll", "pitch", "yaw"}, false);
  position_chart.x = attitude_chart.x = time_range(record);
  return line_chart(position_chart) + line_chart(attitude_chart);
}

std::string eigenvalue_chart(const RunRecord& record, Module module, const std::string& caption) {
  const std::vector<ModuleHealth> rows = solves_of(record, module);
  if (rows.empty()) return {};
  const std::vector<double> times = times_of(rows, start_of(record));
  LineChart chart;
  chart.caption = caption;
  chart.x = time_range(record);
  chart.logarithmic = true;
  chart.height = 240.0;
  for (int i = 0; i < 6; ++i) {
    ChartSeries all{i == 0 ? "λ₁ … λ₆" : "", "c0", times, {}};
    for (const ModuleHealth& row : rows) all.y.push_back(shown_eigenvalue(row, i));
    chart.series.push_back(std::move(all));
  }
  for (int i = 0; i < 6; ++i) {
    ChartSeries degenerate{i == 0 ? "degenerate" : "", "warn", times, {}};
    for (const ModuleHealth& row : rows) {
      degenerate.y.push_back(i < 6 - row.well_conditioned ? shown_eigenvalue(row, i) : kGap);
    }
    chart.series.push_back(std::move(degenerate));
  }
  return line_chart(chart);
}

std::string localization_charts(const RunRecord& record) {
  std::vector<double> times;
  ChartSeries overlap{"near the map", "c0", {}, {}};
  ChartSeries support{"borne out, worst direction", "c1", {}, {}};
  ChartSeries correction{"", "c0", {}, {}};
  for (const MapMatch& match : record.map_matches) {
    times.push_back(seconds_between(start_of(record), match.stamp_ns));
    overlap.y.push_back(match.overlap);
    support.y.push_back(match.support);
    correction.y.push_back(match.correction_m);
  }
  overlap.x = support.x = correction.x = times;
  LineChart shares;
  shares.caption = "Share of what is seen";
  shares.x = time_range(record);
  shares.series = {overlap, support};
  LineChart corrections;
  corrections.caption = "Correction of the prediction";
  corrections.unit = "m";
  corrections.x = time_range(record);
  corrections.series = {correction};
  return line_chart(shares) + line_chart(corrections);
}

std::string flight_charts(const RunRecord& record) {
  ChartSeries tracking{"tracking", "truth", {}, {}};
  ChartSeries estimate{"estimate", "estimate", {}, {}};
  ChartSeries control{"control", "c0", {}, {}};
  ChartSeries near{"", "c0", {}, {}};
  std::vector<double> times;
  for (const FlightSample& sample : record.flight->samples) {
    times.push_back(seconds_between(start_of(record), sample.stamp_ns));
    tracking.y.push_back(tracking_error_m(sample));
    estimate.y.push_back(sample.estimate_error.norm());
    control.y.push_back(control_error_m(sample));
    near.y.push_back(sample.clearance_m);
  }
  tracking.x = estimate.x = control.x = near.x = times;
  LineChart errors;
  errors.caption = "Errors of position";
  errors.unit = "m";
  errors.x = time_range(record);
  errors.series = {tracking, estimate, control};
  LineChart clearance;
  clearance.caption = "Clearance";
  clearance.unit = "m";
  clearance.x = time_range(record);
  clearance.series = {near};
  return line_chart(errors) + line_chart(clearance);
}

std::string correction_charts(const RunRecord& record) {
  const std::vector<ModuleHealth> lidar = solves_of(record, Module::kLidar);
  const std::vector<ModuleHealth> camera = solves_of(record, Module::kVision);
  const std::string strips =
      strip_chart(time_range(record),
                  {status_row("camera", camera, start_of(record)), status_row("lidar", lidar, start_of(record))}) +
      legend({{"solved", "solved"}, {"partial", "partial"}, {"bypassed", "by-passed"}, {"nothing", "no message"}});
  std::string html;
  for (const int first : {0, 3}) {
    html += "<div>";
    for (int axis = first; axis < first + 3; ++axis) html += correction_chart(lidar, record, axis);
    html += strips + "</div>";
  }
  return html;
}

std::string timing_chart(const RunFigures& figures) {
  std::vector<Bar> bars;
  for (const auto& [module, timing] : figures.modules) {
    if (!timing.mean_ms || !timing.p95_ms) continue;
    bars.push_back({std::string(to_string(module)), *timing.mean_ms, *timing.p95_ms,
                    readable_text(*timing.mean_ms) + " ms, p95 " + readable_text(*timing.p95_ms) + " ms"});
  }
  return bar_chart(bars);
}

}  // namespace plumbline
