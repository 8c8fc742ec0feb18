#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "tests/support/synthetic_record.h"
#include "tools/report/markup.h"
#include "tools/report/run_report.h"
#include "tools/report/svg_chart.h"

namespace plumbline {
namespace {

std::string page_of(const RunRecord& record, const Scenario& scenario) {
  RunFigures figures = run_figures(record, [](const Eigen::Vector3d&) { return 0.02; });
  figures.real_time_factor = 1.8;
  const Verdict verdict = judge(scenario, record, figures);
  const Provenance provenance = make_provenance(scenario, 2);
  return report_html({scenario, record, figures, verdict, provenance});
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The page without its pictures, whose base64 may spell anything.
std::string without_pictures(const std::string& page) {
  std::string text;
  std::size_t at = 0;
  for (std::size_t found = page.find("base64,"); found != std::string::npos; found = page.find("base64,", at)) {
    text.append(page, at, found - at);
    at = page.find('"', found);
  }
  return text.append(page, at);
}

Scenario a_scenario() {
  Scenario scenario;
  scenario.name = "corridor";
  scenario.path = "scenarios/corridor.yaml";
  scenario.expect.push_back({"drift_percent", std::nullopt, 0.5});
  scenario.resolved_yaml = "seed: 1\nworld:\n  scene: corridor\n";
  return scenario;
}

TEST(Report, ShowsEverySectionOfARun) {
  const std::string page = page_of(testing::synthetic_record(), a_scenario());
  for (const char* title : {"Path and map", "Error over time", "Degeneracy", "Scan matching&#39;s corrections",
                            "Camera", "Time and messages", "All figures", "Provenance"}) {
    EXPECT_TRUE(contains(page, title)) << title;
  }
  EXPECT_TRUE(contains(page, "drift_percent"));
  EXPECT_LT(page.size(), 3'000'000U);
  // For looking at: PLUMBLINE_REPORT_TO=/tmp/report.html build/release/tests/tools/tools_test
  if (const char* path = std::getenv("PLUMBLINE_REPORT_TO")) std::ofstream(path) << page;
}

TEST(Report, SaysHowAFlightInClosedLoopWent) {
  RunRecord record = testing::synthetic_record();
  EXPECT_FALSE(contains(page_of(record, a_scenario()), "Flight in closed loop"));
  record.flight.emplace();
  record.flight->waypoints = {{0.0, 0.0, 2.0}, {9.0, 0.0, 2.0}};
  record.flight->end = FlightEnd::kStruck;
  for (int i = 0; i < 100; ++i) {
    FlightSample sample;
    sample.stamp_ns = i * 10'000'000;
    sample.flown = {0.01 * i, 0.0, 2.0};
    sample.wanted = sample.flown;
    sample.estimate_error = {0.0, 0.01 * i, 0.0};
    record.flight->samples.push_back(sample);
  }
  const std::string page = page_of(record, a_scenario());
  EXPECT_TRUE(contains(page, "Flight in closed loop"));
  EXPECT_TRUE(contains(page, "The flight ended: struck. First to leave its bound of 0.500 m: estimate."));
}

TEST(Report, NeedsNothingFromOutside) {
  const std::string page = page_of(testing::synthetic_record(), a_scenario());
  for (const char* outside : {"http:", "https:", "src=", "@import", "url(", "<script", "<link"}) {
    EXPECT_FALSE(contains(page, outside)) << outside;
  }
}

TEST(Report, NumbersThatAreNotFiniteDrawNothing) {
  RunRecord record = testing::synthetic_record();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 3000; i < record.estimate.size(); ++i) record.estimate[i].pose.translation.x() = nan;
  record.map.push_back({{std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F}, 0.0F});
  const std::string page = without_pictures(page_of(record, a_scenario()));
  for (const char* written : {"\"nan", " nan", ">nan", "Mnan", "Lnan", "inf\""}) {
    EXPECT_FALSE(contains(page, written)) << written;
  }
}

TEST(Report, StandsForARunThatEndedBeforeItBegan) {
  RunRecord record;
  record.fault = "out of memory";
  const std::string page = page_of(record, a_scenario());
  EXPECT_TRUE(contains(page, "out of memory"));
  EXPECT_TRUE(contains(page, "badge error"));
}

TEST(Report, EscapesEverythingItWasGiven) {
  RunRecord record = testing::synthetic_record();
  record.fault = "<script>alert(1)</script>";
  record.messages[Module::kLidar].dropped["<b>\"reason\"</b>"] = 1;
  Scenario scenario = a_scenario();
  scenario.name = "<i>name</i>";
  scenario.resolved_yaml = "</pre><em>";
  const std::string page = page_of(record, scenario);
  for (const char* raw : {"<script", "<i>name", "<em>", "<b>\"reason"}) EXPECT_FALSE(contains(page, raw)) << raw;
  EXPECT_TRUE(contains(page, "&lt;script&gt;alert(1)"));
}

TEST(Markup, EscapesForElementsAndAttributes) { EXPECT_EQ(escape_markup("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;"); }

TEST(Markup, DataAddressIsBase64) {
  EXPECT_EQ(png_data_address({'M', 'a', 'n'}), "data:image/png;base64,TWFu");
  EXPECT_EQ(png_data_address({'M', 'a'}), "data:image/png;base64,TWE=");
  EXPECT_EQ(png_data_address({'M'}), "data:image/png;base64,TQ==");
}

TEST(Chart, TicksAreRoundAndInside) {
  EXPECT_EQ(axis_ticks({0.0, 10.0}, 5), (std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
  EXPECT_EQ(axis_ticks({-1.0, 1.0}, 4), (std::vector<double>{-1.0, -0.5, 0.0, 0.5, 1.0}));
  EXPECT_EQ(axis_ticks({3.0, 3.0}, 4).size(), 1U);
}

TEST(Chart, ThinningKeepsExtremesAndBreaks) {
  ChartSeries series;
  for (int i = 0; i < 100'000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 54'321 ? 9.0 : 0.0);
  }
  series.y[70'000] = std::numeric_limits<double>::quiet_NaN();
  const ChartSeries thin = thinned(series, 1500);
  EXPECT_LE(thin.x.size(), 1500U);
  EXPECT_EQ(*std::max_element(thin.y.begin(), thin.y.begin() + 300), 9.0);
  EXPECT_EQ(std::count_if(thin.y.begin(), thin.y.end(), [](double y) { return std::isnan(y); }), 1);
}

TEST(Chart, AnEmptyChartIsStillAChart) {
  LineChart chart;
  chart.caption = "Nothing <yet>";
  EXPECT_TRUE(contains(line_chart(chart), "Nothing &lt;yet&gt;"));
}

}  // namespace
}  // namespace plumbline
