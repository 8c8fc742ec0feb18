#include "tools/report/sweep_report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "tools/report/heat_map.h"
#include "tools/report/point_chart.h"

namespace plumbline {
namespace {

bool page_contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

AxisValue number(double value) { return {std::to_string(static_cast<int>(value)), value}; }

/// Two axes, two estimators, three seeds; the second estimator fails in the dark, one run crashes.
SweepPlan a_plan() {
  SweepPlan plan;
  plan.name = "light <and> speed";
  plan.scenario = "corridor";
  plan.axes = {{"motion.speed_factor", false, {number(1), number(2)}, {}},
               {"world.light.lux", true, {number(1), number(10), number(100)}, {}}};
  plan.estimators = {"imu_lidar", "vio"};
  plan.seeds = {1, 2, 3};
  for (const AxisValue& speed : plan.axes[0].values) {
    for (const AxisValue& lux : plan.axes[1].values) {
      for (const std::string& estimator : plan.estimators) {
        for (const std::uint64_t seed : plan.seeds) {
          plan.runs.push_back({std::to_string(1000 + plan.runs.size()), {speed, lux}, estimator, seed, "d"});
        }
      }
    }
  }
  return plan;
}

std::vector<RunRow> rows_of(const SweepPlan& plan) {
  std::vector<StoredRun> stored;
  for (const PlannedRun& run : plan.runs) {
    const bool is_dark = *run.values[1].number < 5.0 && run.estimator == "vio";
    const std::string drift = std::to_string((is_dark ? 8.0 : 0.2) + 0.01 * static_cast<double>(run.seed));
    stored.push_back({run.key, "finished", is_dark ? "drift_percent: expected at most 1" : "",
                      std::string("{\"status\":\"") + (is_dark ? "failed" : "ok") + "\",\"drift_percent\":" + drift +
                          ",\"modules\":{\"lidar\":{\"degenerate_share\":0.25}}}",
                      "", 1.0, 1.0, 100.0});
  }
  stored.front() = {plan.runs.front().key, "crashed", "killed by <signal> 11", "", "", 1.0, 1.0, 100.0};
  return run_rows(plan, stored);
}

TEST(SweepReport, ShowsChartsIntervalsAndRankedFailures) {
  const SweepPlan plan = a_plan();
  const SweepReport report = sweep_report(plan, rows_of(plan));
  for (const char* title : {"Estimators", "Failures", "Success", "Drift", "Degeneracy", "All runs"}) {
    EXPECT_TRUE(page_contains(report.html, title)) << title;
  }
  // 29 of 36: Wilson's interval, worked out by hand to the digit that is shown.
  EXPECT_TRUE(page_contains(report.html, "80.6 <small>% (65.0 … 90.2)"));
  // The crash stands before the broken expectations, and links nowhere: it has no page.
  EXPECT_LT(report.html.find("killed by &lt;signal&gt; 11"), report.html.find("expected at most 1"));
  EXPECT_TRUE(page_contains(report.html, "href=\"runs/1003/report.html\""));
  EXPECT_FALSE(page_contains(report.html, "runs/1000/report.html"));
  if (const char* path = std::getenv("PLUMBLINE_REPORT_TO")) std::ofstream(path) << report.html;
}

TEST(SweepReport, EveryChartIsADocumentOfItsOwn) {
  const SweepPlan plan = a_plan();
  const SweepReport report = sweep_report(plan, rows_of(plan));
  // Success and drift: an axis each, twice, and a map per estimator; degeneracy: an axis and an estimator each.
  EXPECT_EQ(report.charts.size(), 2U * (2U + 2U) + 4U);
  for (const Drawing& chart : report.charts) {
    const std::string svg = svg_document(chart);
    EXPECT_TRUE(page_contains(svg, "xmlns=\"http://www.w3.org/2000/svg\"")) << chart.name;
    EXPECT_TRUE(page_contains(svg, "<style>")) << chart.name;
    EXPECT_EQ(chart.name.find_first_of("/. "), std::string::npos) << chart.name;
  }
}

/// Whole mappings as settings of an axis ran into one smear beneath it.
TEST(SweepReport, SettingsInWordsHaveRowsOfTheirOwn) {
  PointChart chart;
  chart.joined = false;
  chart.series.push_back({"vloam", "c0", {}});
  for (int i = 0; i < 12; ++i) {
    const std::string words = "{scene: \"hall <" + std::to_string(10 + i) + ">\", parameters: {column_spacing_m: 4}}";
    chart.ticks.push_back({static_cast<double>(i), words});
    chart.series[0].points.push_back({static_cast<double>(i), {0.5, 0.4, 0.6}});
  }
  const Drawing drawing = point_chart(chart);
  std::set<std::string> heights;
  for (int i = 0; i < 12; ++i) {
    const std::size_t at = drawing.body.find(">scene: hall &lt;" + std::to_string(10 + i));
    ASSERT_NE(at, std::string::npos) << i;
    const std::size_t y = drawing.body.rfind(" y=\"", at);
    heights.insert(drawing.body.substr(y, drawing.body.find('"', y + 4) - y));
  }
  EXPECT_EQ(heights.size(), 12U);
  EXPECT_GE(drawing.height, 12.0 * 13.0) << "a row is as high as its letters";
}

TEST(SweepReport, NeedsNothingFromOutsideAndEscapesWhatItWasGiven) {
  const SweepPlan plan = a_plan();
  const std::string page = sweep_report(plan, rows_of(plan)).html;
  for (const char* outside : {"http:", "https:", "src=", "@import", "url(", "<script", "<link", "<and>", "nan"}) {
    EXPECT_FALSE(page_contains(page, outside)) << outside;
  }
}

TEST(SweepReport, StandsBeforeAnyRunHasEnded) {
  EXPECT_TRUE(page_contains(sweep_report(a_plan(), {}).html, "of 36 planned"));
}

}  // namespace
}  // namespace plumbline
