#include "tools/report/sweep_tables_html.h"

#include <algorithm>
#include <map>

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"
#include "tools/report/page_parts.h"
#include "tools/study/boundary_curves.h"
#include "tools/study/statistics.h"

namespace plumbline {
namespace {

constexpr std::size_t kMostFailures = 100;
constexpr std::size_t kMostRows = 1000;

std::string with_limits(const std::optional<Interval>& interval, double factor = 1.0) {
  if (!interval) return "–";
  return readable_text(factor * interval->value) + " (" + readable_text(factor * interval->low) + " … " +
         readable_text(factor * interval->high) + ")";
}

std::vector<const RunRow*> rows_of(const std::vector<RunRow>& rows, const std::string& estimator) {
  std::vector<const RunRow*> found;
  for (const RunRow& row : rows) {
    if (row.run.estimator == estimator) found.push_back(&row);
  }
  return found;
}

std::vector<double> figures_of(const std::vector<const RunRow*>& rows, const std::string& key) {
  std::vector<double> values;
  for (const RunRow* row : rows) {
    if (const auto value = row->figure(key)) values.push_back(*value);
  }
  return values;
}

/// Drift of one estimator over that of another in the same conditions, where both have one.
std::vector<double> drift_ratios(const SweepPlan& plan, const std::vector<RunRow>& rows, const std::string& estimator,
                                 const std::string& other) {
  std::map<std::string, double> drift_of_other;
  const auto conditions = [&](const RunRow& row) {
    PlannedRun run = row.run;
    run.estimator.clear();
    return describe(plan, run);
  };
  for (const RunRow* row : rows_of(rows, other)) {
    if (const auto drift = row->figure("drift_percent")) drift_of_other[conditions(*row)] = *drift;
  }
  std::vector<double> ratios;
  for (const RunRow* row : rows_of(rows, estimator)) {
    const auto drift = row->figure("drift_percent");
    const auto found = drift_of_other.find(conditions(*row));
    if (drift && found != drift_of_other.end() && found->second > 0.0) ratios.push_back(*drift / found->second);
  }
  return ratios;
}

std::string mean_percent(const std::vector<double>& shares) {
  if (shares.empty()) return "–";
  double sum = 0.0;
  for (const double share : shares) sum += share;
  return readable_text(100.0 * sum / static_cast<double>(shares.size())) + " %";
}

/// What leads to a run: its page where it has one.
std::string run_link(const RunRow& row) {
  if (row.outcome != "finished") return "<td>" + row.run.key + "</td>";
  return "<td><a href=\"runs/" + row.run.key + "/report.html\">" + row.run.key + "</a></td>";
}

int severity(const RunRow& row) {
  if (row.status == "error") return 0;
  return row.status == "lost" ? 1 : 2;
}

bool worse(const RunRow* a, const RunRow* b) {
  if (severity(*a) != severity(*b)) return severity(*a) < severity(*b);
  return a->figure("drift_percent").value_or(0.0) > b->figure("drift_percent").value_or(0.0);
}

std::string run_row(const SweepPlan& plan, const RunRow& row) {
  const std::string badge = "<td><span class=\"badge " + escape_markup(row.status) + "\">" +
                            escape_markup(row.outcome == "finished" ? row.status : row.outcome) + "</span></td>";
  return "<tr>" + run_link(row) + badge + text_cell(describe(plan, row.run)) +
         number_cell(shown(row.figure("drift_percent"))) + number_cell(shown(row.figure("progress_ratio"))) +
         text_cell(row.reason) + "</tr>";
}

std::string run_head() {
  return "<tr><th>run</th><th>status</th><th>settings</th><th class=\"number\">drift, %</th><th "
         "class=\"number\">progress</th><th>why</th></tr>";
}

}  // namespace

std::string estimator_table(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const std::string& first = plan.estimators.front();
  std::string html = head_row({"estimator"}, {"runs", "success, %", "median drift, %", "drift against " + first,
                                              "lidar degenerate", "vision degenerate"});
  for (const std::string& estimator : plan.estimators) {
    const auto own = rows_of(rows, estimator);
    const auto ok =
        static_cast<std::size_t>(std::count_if(own.begin(), own.end(), [](const RunRow* row) { return row->is_ok(); }));
    const auto rate = own.empty() ? std::nullopt : std::optional(wilson_interval(ok, own.size()));
    const auto ratio = bootstrap_median(drift_ratios(plan, rows, estimator, first), "sweep.report.ratio");
    html += "<tr>" + text_cell(estimator) + number_cell(std::to_string(own.size())) +
            number_cell(with_limits(rate, 100.0)) +
            number_cell(with_limits(bootstrap_median(figures_of(own, "drift_percent"), "sweep.report.drift"))) +
            number_cell(estimator == first ? "" : "× " + with_limits(ratio)) +
            number_cell(mean_percent(figures_of(own, "modules.lidar.degenerate_share"))) +
            number_cell(mean_percent(figures_of(own, "modules.vision.degenerate_share"))) + "</tr>";
  }
  return wide_table(html);
}

std::string failure_table(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  std::vector<const RunRow*> failures;
  for (const RunRow& row : rows) {
    if (!row.is_ok()) failures.push_back(&row);
  }
  if (failures.empty()) return "<div class=\"card\">None.</div>";
  std::stable_sort(failures.begin(), failures.end(), worse);
  const std::size_t count = std::min(failures.size(), kMostFailures);
  std::string html = run_head();
  for (std::size_t i = 0; i < count; ++i) html += run_row(plan, *failures[i]);
  if (count == failures.size()) return wide_table(html);
  return wide_table(html) + "<p class=\"note\">and " + std::to_string(failures.size() - count) +
         " more, in table.csv</p>";
}

std::string run_table(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const std::size_t count = std::min(rows.size(), kMostRows);
  std::string html = run_head();
  for (std::size_t i = 0; i < count; ++i) html += run_row(plan, rows[i]);
  return "<details><summary>" + std::to_string(count) + " of " + std::to_string(rows.size()) + " runs</summary>" +
         wide_table(html) + "</details>";
}

std::string boundary_table(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const SweepAxis& axis = plan.axes[plan.boundary().value()];
  std::string html =
      head_row({"of", axis.key + " at the boundary (95 %)", "which side succeeds"}, {"runs", "whole grid"});
  for (const BoundaryCurve& curve : boundary_curves(plan)) {
    const BoundarySearch search = replay(curve, rows).search;
    const BoundaryEstimate estimate = search.curve().boundary();
    const bool is_inside = estimate.probability_inside > 0.5;
    const Interval place{value_of_share(axis, estimate.median), value_of_share(axis, estimate.low),
                         value_of_share(axis, estimate.high)};
    const std::string side = estimate.probability_falling > 0.5 ? "below" : "above";
    html += "<tr>" + text_cell(curve.label) +
            text_cell(is_inside ? with_limits(place)
                                : "none in this range (with " +
                                      readable_text(100.0 * (1.0 - estimate.probability_inside)) + " % probability)") +
            text_cell(is_inside ? side : "–") + number_cell(std::to_string(search.made())) +
            number_cell(std::to_string(curve.positions.size() * curve.keys.front().size())) + "</tr>";
  }
  return wide_table(html);
}

std::string origin_table(const SweepPlan& plan) {
  std::string html;
  const auto add = [&](const std::string& name, const std::string& text) {
    html += "<tr><th>" + escape_markup(name) + "</th>" + text_cell(text) + "</tr>";
  };
  add("Plumbline", plan.program);
  add("Scenario", plan.scenario);
  for (const std::string& fixed : plan.fixed) add("Set", fixed);
  for (const SweepAxis& axis : plan.axes) {
    add(axis.key, axis.range ? readable_text(axis.range->first) + " … " + readable_text(axis.range->second) +
                                   (axis.logarithmic ? ", logarithmic, sampled" : ", sampled")
                             : std::to_string(axis.values.size()) + " values, " + axis.values.front().text + " … " +
                                   axis.values.back().text);
  }
  add("Seeds", std::to_string(plan.seeds.size()));
  add("Limits", readable_text(plan.limits.time_s) + " s, " + readable_text(plan.limits.memory_mb) + " MB a run");
  return "<div class=\"card\"><table>" + html + "</table></div>";
}

}  // namespace plumbline
