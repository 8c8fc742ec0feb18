#include "tools/report/sweep_report.h"

#include <algorithm>

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"
#include "tools/report/page_parts.h"
#include "tools/report/sweep_charts.h"
#include "tools/report/sweep_tables_html.h"
#include "tools/study/statistics.h"

namespace plumbline {
namespace {

std::string title_block(const SweepPlan& plan) {
  return "<header><h1>" + escape_markup(plan.name) + "</h1><span class=\"badge\">sweep</span><span class=\"sub\">" +
         escape_markup(plan.scenario) + "</span></header>";
}

std::string tiles(const SweepView& view) {
  const std::size_t ended = view.rows.size();
  const auto ok = static_cast<std::size_t>(
      std::count_if(view.rows.begin(), view.rows.end(), [](const RunRow& row) { return row.is_ok(); }));
  std::string html = "<div class=\"tiles\">";
  html += tile("Runs", std::to_string(ended), "of " + std::to_string(view.plan.runs.size()) + " planned");
  if (ended > 0) {
    const Interval rate = wilson_interval(ok, ended);
    html += tile("Success", readable_text(100.0 * rate.value),
                 "% (" + readable_text(100.0 * rate.low) + " … " + readable_text(100.0 * rate.high) + ")");
  }
  std::vector<double> drifts;
  double wall_s = 0.0;
  for (const RunRow& row : view.rows) {
    if (const auto drift = row.figure("drift_percent")) drifts.push_back(*drift);
    wall_s += row.wall_s;
  }
  if (const auto drift = bootstrap_median(drifts, "sweep.report.drift")) {
    html += tile("Median drift", readable_text(drift->value),
                 "% (" + readable_text(drift->low) + " … " + readable_text(drift->high) + ")");
  }
  html += tile("Failures", std::to_string(ended - ok), "ranked below");
  return html + tile("Time of all runs", readable_text(wall_s / 60.0), "min") + "</div>";
}

/// A section of charts, which also go into `all`; nothing where there are none.
std::string chart_section(const std::string& title, const std::string& note, std::vector<Drawing> drawings,
                          std::vector<Drawing>& all) {
  if (drawings.empty()) return {};
  std::string html = heading(title, note) + "<div class=\"pair\">";
  for (Drawing& drawing : drawings) {
    html += figure_html(drawing);
    all.push_back(std::move(drawing));
  }
  return html + "</div>";
}

std::string charts_html(const SweepView& view, std::vector<Drawing>& all) {
  return chart_section("Success",
                       "Share of runs whose status is ok, with Wilson's 95 % interval. A crash, a hang and a run that "
                       "breaks its expectations count as failures alike.",
                       success_charts(view), all) +
         chart_section("Drift",
                       "Median over runs with its 95 % bootstrap interval. Runs that ended without a figure are left "
                       "out here; they count above.",
                       drift_charts(view), all) +
         chart_section("Degeneracy",
                       "In how many of its solves each module found at least one direction that its data do not "
                       "determine.",
                       degeneracy_charts(view), all);
}

}  // namespace

SweepReport sweep_report(const SweepPlan& plan, const std::vector<RunRow>& rows, const LabFindings& lab) {
  const SweepView view(plan, rows);
  SweepReport report;
  std::string boundary = chart_section(
      "Boundary", "The value at which success and failure are equally likely, from runs chosen where each tells most.",
      boundary_charts(view), report.charts);
  if (!boundary.empty()) boundary += boundary_table(plan, rows);
  const std::string detectors = lab_section(lab, report.charts);
  const std::string charts = charts_html(view, report.charts);
  report.html = page_html(
      plan.name,
      title_block(plan) + tiles(view) + boundary + detectors +
          heading("Estimators",
                  "Intervals are 95 %. Compared pairwise: over the runs that both made with the same settings and "
                  "seed, the "
                  "median ratio of their drifts.") +
          estimator_table(plan, rows) +
          heading("Failures",
                  "The worst first: runs without a result, then lost ones, then broken expectations, each by "
                  "drift. Every number leads to the run's own page.") +
          failure_table(plan, rows) + charts + heading("All runs", "As in table.csv and table.jsonl.") +
          run_table(plan, rows) + heading("How it was made", "The same file, seeds and program give the same tables.") +
          origin_table(plan));
  return report;
}

}  // namespace plumbline
