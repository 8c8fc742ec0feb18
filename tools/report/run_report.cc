#include "tools/report/run_report.h"

#include "tools/formats/number_text.h"
#include "tools/report/camera_picture.h"
#include "tools/report/map_picture.h"
#include "tools/report/markup.h"
#include "tools/report/page_parts.h"
#include "tools/report/run_charts.h"

namespace plumbline {
namespace {

std::string figure_tile(const std::string& name, const std::optional<double>& value, const std::string& unit) {
  return tile(name, shown(value), value ? unit : "");
}

std::string title_block(const RunReport& report) {
  const std::string status = to_string(report.verdict.status);
  return "<header><h1>" + escape_markup(report.scenario.name) + "</h1><span class=\"badge " + status + "\">" + status +
         "</span><span class=\"sub\">" + escape_markup(report.provenance.estimator) + ", seed " +
         std::to_string(report.provenance.seed) + "</span></header>";
}

std::string tiles(const RunFigures& figures) {
  const TrajectoryFigures& t = figures.trajectory;
  const auto degrees = t.ape ? std::optional(t.ape->rotation_deg) : std::nullopt;
  const auto metres = t.ape ? std::optional(t.ape->translation_m) : std::nullopt;
  const auto lidar = figures.modules.find(Module::kLidar);
  const auto share = lidar == figures.modules.end() ? std::nullopt : lidar->second.degenerate_share;
  const auto degenerate = share ? std::optional(100.0 * *share) : std::nullopt;
  return "<div class=\"tiles\">" + figure_tile("Drift", t.drift_percent, "%") +
         figure_tile("Progress", t.progress.whole, "× true") +
         figure_tile("Progress, worst 5 s", t.progress.worst_5s, "× true") +
         figure_tile("Position error, rms", metres, "m") + figure_tile("Attitude error, rms", degrees, "°") +
         figure_tile("Map error, rms", figures.map.rmse_m, "m") +
         figure_tile("Scan matching degenerate", degenerate, "%") + figure_tile("Distance", t.distance_m, "m") +
         figure_tile("Duration", t.duration_s, "s") + figure_tile("Speed", figures.real_time_factor, "× real time") +
         "</div>";
}

std::string list_item(bool holds, const std::string& text) {
  return std::string("<li class=\"") + (holds ? "held" : "broken") + "\">" + (holds ? "✓ " : "✗ ") +
         escape_markup(text) + "</li>";
}

std::string checks(const RunReport& report) {
  std::string items;
  if (!report.record.fault.empty()) items += list_item(false, "The run ended early: " + report.record.fault);
  if (report.record.estimator_lost) items += list_item(false, "The estimator says that it is lost");
  if (const auto since = report.figures.trajectory.lost_since_s) {
    items += list_item(
        false, "Since " + readable_text(*since) + " s the position error exceeds 1 m + 10 % of the distance travelled");
  }
  for (const Check& check : report.verdict.checks) items += list_item(check.holds, describe(check));
  if (const auto& expected = report.verdict.expected_status) {
    const bool met = *expected == to_string(report.verdict.status);
    items += list_item(met, "status = " + to_string(report.verdict.status) + ", expected " + *expected);
  }
  return items.empty() ? "" : "<ul class=\"checks\">" + items + "</ul>";
}

/// Where no truth is known the estimate is all there is to draw.
std::string blind_map_section(const RunReport& report) {
  std::vector<PosePair> path;
  for (const auto& [stamp_ns, pose] : report.record.estimate) path.push_back({stamp_ns, pose, pose});
  return heading("Path and map", "The estimate and the map it built. The true path is not known.") +
         "<div class=\"legend\"><span><i class=\"estimate\"></i>estimate</span><span><i "
         "style=\"--hue:#808080\"></i>mapped "
         "points</span></div>" +
         map_picture(MapView::kTop, path, report.record.map, {}) +
         map_picture(MapView::kSide, path, report.record.map, {});
}

std::string map_section(const RunReport& report) {
  const TrajectoryFigures& t = report.figures.trajectory;
  if (!t.has_truth) return blind_map_section(report);
  const Pose& truth_from_estimate = t.drift_alignment.truth_from_estimate;
  return heading("Path and map",
                 "The estimate and the map it built, laid over the truth by the first second of motion alone, so that "
                 "what is off further on is drift.") +
         "<div class=\"legend\"><span><i class=\"truth\"></i>true path</span><span><i class=\"estimate\"></i>estimate"
         "</span><span><i style=\"--hue:#808080\"></i>mapped points</span></div>" +
         map_picture(MapView::kTop, t.aligned, report.record.map, truth_from_estimate) +
         map_picture(MapView::kSide, t.aligned, report.record.map, truth_from_estimate);
}

std::string degeneracy_section(const RunRecord& record) {
  const std::string charts = eigenvalue_chart(record, Module::kVision, "Visual-inertial odometry") +
                             eigenvalue_chart(record, Module::kLidar, "Scan matching");
  if (charts.empty()) return {};
  return heading("Degeneracy",
                 "Eigenvalues of each module's data. Directions below the threshold are marked: there the module is "
                 "by-passed and the coarser prediction stands.") +
         "<div class=\"pair\">" + charts + "</div>";
}

std::string localization_section(const RunReport& report) {
  if (!report.figures.localization) return {};
  const LocalizationFigures& figures = *report.figures.localization;
  std::string rows;
  for (const auto& [outcome, count] : figures.outcomes) {
    rows += "<tr>" + text_cell(outcome) + number_cell(std::to_string(count)) + "</tr>";
  }
  return heading("Localization", "Stacks of scans held against " + report.record.prior_map +
                                     ". Where map and scans disagree, odometry goes on with the last correction.") +
         "<div class=\"tiles\">" + figure_tile("Localized at the end", figures.at_end ? 1.0 : 0.0, "") +
         figure_tile("Median error", figures.error_median_m, "m") +
         figure_tile("Worst error", figures.error_max_m, "m") +
         figure_tile("Borne out by the map", figures.support_median, "") + "</div><div class=\"pair\">" +
         localization_charts(report.record) + wide_table(head_row({"match"}, {"count"}) + rows) + "</div>";
}

std::string flight_section(const RunReport& report) {
  if (!report.figures.flight) return {};
  const FlightFigures& figures = *report.figures.flight;
  const std::string outcome = figures.origin == FailureOrigin::kNone
                                  ? "Flown as asked."
                                  : "The flight ended: " + to_string(figures.end) + ". First to leave its bound of " +
                                        readable_text(kWaypointReach_m) + " m: " + to_string(figures.origin) + ".";
  return heading("Flight in closed loop",
                 "The craft flew on the estimate. Tracking: from the mission; estimate: of what the controller was "
                 "told; control: what is left of tracking without the estimate's. " +
                     outcome) +
         "<div class=\"tiles\">" +
         figure_tile("Way-points missed", static_cast<double>(figures.waypoints_missed),
                     " of " + std::to_string(figures.waypoints)) +
         figure_tile("Collisions", static_cast<double>(figures.collisions), "") +
         figure_tile("Least clearance", figures.clearance_min_m, "m") +
         figure_tile("Tracking error, worst", figures.tracking_error_max_m, "m") + "</div><div class=\"pair\">" +
         flight_charts(report.record) + "</div>";
}

std::string camera_section(const RunRecord& record) {
  std::string pictures;
  for (const FrameSnapshot& snapshot : record.snapshots) {
    pictures += camera_picture(snapshot, start_of(record));
  }
  if (pictures.empty()) return {};
  return heading("Camera", "What the estimator saw and tracked; lines lead to where the key-frame saw each feature.") +
         camera_legend() + "<div class=\"triple\">" + pictures + "</div>";
}

std::string message_table(const RunFigures& figures) {
  std::string html =
      "<div class=\"card scroll\"><table><tr><th>messages</th><th class=\"number\">produced</th><th "
      "class=\"number\">used"
      "</th><th>dropped</th></tr>";
  for (const auto& [module, tally] : figures.messages) {
    std::string dropped;
    for (const auto& [reason, count] : tally.dropped) {
      dropped += (dropped.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    }
    html += "<tr><td>" + message_key(module) + "</td><td class=\"number\">" + std::to_string(tally.produced) +
            "</td><td class=\"number\">" + std::to_string(tally.used) + "</td><td>" +
            escape_markup(dropped.empty() ? "none" : dropped) + "</td></tr>";
  }
  return html + "</table></div>";
}

std::string cost_section(const RunFigures& figures) {
  return heading("Time and messages", "Processing time per message: mean as a bar, 95th percentile as a whisker.") +
         "<div class=\"pair\">" + timing_chart(figures) + message_table(figures) + "</div>";
}

std::string figure_table(const RunFigures& figures) {
  std::string rows;
  for (const Figure& figure : figure_list(figures)) {
    const std::string value = !figure.value     ? "null"
                              : figure.is_count ? fixed_text(*figure.value, 0)
                                                : readable_text(*figure.value);
    rows += "<tr><td>" + escape_markup(figure.key) + "</td><td class=\"number\">" + value + "</td></tr>";
  }
  return heading("All figures", "As in result.json.") + "<div class=\"card columns\"><table>" + rows + "</table></div>";
}

std::string provenance_section(const RunReport& report) {
  std::string rows;
  for (const auto& [name, value] : provenance_rows(report.provenance)) {
    rows += "<tr><th>" + escape_markup(name) + "</th><td>" + escape_markup(value) + "</td></tr>";
  }
  return heading("Provenance", "Same scenario, seed, program and machine give the same trajectory, byte for byte.") +
         "<div class=\"card\"><table>" + rows + "</table><details><summary>Resolved scenario</summary><pre>" +
         escape_markup(report.scenario.resolved_yaml) + "</pre></details></div>";
}

}  // namespace

std::string report_html(const RunReport& report) {
  const RunRecord& record = report.record;
  return page_html(
      report.scenario.name,
      title_block(report) + tiles(report.figures) + checks(report) + flight_section(report) + map_section(report) +
          heading("Error over time", "In the true body's axes: forward, left, up.") + "<div class=\"pair\">" +
          error_charts(record, report.figures.trajectory) + "</div>" + degeneracy_section(record) +
          localization_section(report) +
          heading("Scan matching's corrections", "What each registration changed of the prediction it started from.") +
          "<div class=\"pair\">" + correction_charts(record) + "</div>" + camera_section(record) +
          cost_section(report.figures) + figure_table(report.figures) + provenance_section(report));
}

}  // namespace plumbline
