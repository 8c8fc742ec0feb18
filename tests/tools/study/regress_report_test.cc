#include "tools/report/regress_report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/tools/study/synthetic_suite.h"
#include "tools/report/regress_text.h"

namespace plumbline {
namespace {

using testing::synthetic_suite;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Baseline a_side(const std::string& program, std::vector<MeasuredRun> runs) {
  return {"ci", "0123", "vloam", program, {"a processor", 2, "Debian"}, std::move(runs)};
}

/// The tunnel's error doubles, one run crashes with a message that is no text.
Regression a_regression() {
  auto after = synthetic_suite(8, "b");
  for (MeasuredRun& run : after) {
    if (run.scenario == "tunnel") testing::worsen(run, 2.0);
  }
  after.front().status = "error";
  after.front().reason = "<signal> & \x01 | bang";
  return make_regression(a_side("0.1 (before)", synthetic_suite(8, "a")), a_side("0.2 (after)", after), {});
}

TEST(RegressReport, TellsTheVerdictWithBeforeAndAfter) {
  const Regression regression = a_regression();
  const RegressReport report = regress_report(regression);
  for (const char* text : {"regression</span>", "in tunnel", "0.1 (before)", "0.2 (after)", "1 s relative error",
                           "Growth by scenario", "href=\"runs/1/report.html\"", "ends in an error"}) {
    EXPECT_TRUE(contains(report.html, text)) << text;
  }
  EXPECT_FALSE(contains(report.html, "runs/0/report.html"));
  // Growth of three figures, before and after of six.
  EXPECT_EQ(report.charts.size(), 9U);
  if (const char* path = std::getenv("PLUMBLINE_REPORT_TO")) std::ofstream(path) << report.html;
}

TEST(RegressReport, NeedsNothingFromOutsideAndEscapesWhatItWasGiven) {
  const std::string page = regress_report(a_regression()).html;
  for (const char* outside : {"http:", "https:", "src=", "@import", "url(", "<script", "<link", "<signal>", "nan"}) {
    EXPECT_FALSE(contains(page, outside)) << outside;
  }
}

TEST(RegressReport, StandsWithoutChangesAndWithoutRuns) {
  const auto runs = synthetic_suite(8, "a");
  EXPECT_TRUE(
      contains(regress_report(make_regression(a_side("a", runs), a_side("a", runs), {})).html, "no regression"));
  EXPECT_FALSE(contains(regress_report(make_regression(a_side("a", {}), a_side("a", {}), {})).html, "nan"));
}

TEST(RegressReport, SaysThatTheMachineIsAnother) {
  Baseline before = a_side("a", synthetic_suite(8, "a"));
  before.machine.cpu = "a faster one";
  const Regression regression = make_regression(std::move(before), a_side("a", synthetic_suite(8, "a")), {});
  EXPECT_TRUE(contains(regress_markdown(regression), "another class of machine (a faster one; here a processor)"));
  EXPECT_TRUE(contains(regress_markdown(regression), "only shown"));
}

TEST(RegressText, JunitCountsItsFailuresAndIsXml) {
  const std::string xml = regress_junit(a_regression());
  EXPECT_TRUE(contains(xml, "<testsuite name=\"ci.runs\" tests=\"48\" failures=\"1\""));
  EXPECT_TRUE(contains(xml, "<testsuite name=\"ci.relative_error\" tests=\"7\""));
  EXPECT_TRUE(contains(xml, "name=\"tunnel\" time=\"0.000\"><failure message=\"1 s relative error grew"));
  EXPECT_TRUE(contains(xml, "&lt;signal&gt; &amp;  | bang"));
  if (const char* path = std::getenv("PLUMBLINE_JUNIT_TO")) std::ofstream(path) << xml;
}

TEST(RegressText, MarkdownKeepsItsTables) {
  const std::string text = regress_markdown(a_regression());
  EXPECT_TRUE(contains(text, "shows a regression"));
  EXPECT_TRUE(contains(text, "\\<signal> & \x01 \\| bang") || contains(text, "\\<signal>"));
  EXPECT_TRUE(contains(text, "| 1 s relative error, tunnel |"));
}

}  // namespace
}  // namespace plumbline
