#include "tools/evaluation/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scenarios/figures.h"

namespace plumbline {
namespace {

struct Case {
  Scenario scenario;
  RunRecord record;
  RunFigures figures;

  Case() { figures.trajectory.drift_percent = 0.4; }
  Case& expect_drift_at_most(double max) {
    scenario.expect.push_back({"drift_percent", std::nullopt, max});
    return *this;
  }
  Case& lost() {
    figures.trajectory.lost_since_s = 12.0;
    return *this;
  }
  Case& fault() {
    record.fault = "the estimator threw";
    return *this;
  }
  Case& expect_status(const std::string& status) {
    scenario.expect_status = status;
    return *this;
  }
  std::pair<std::string, int> judged() const {
    const Verdict verdict = judge(scenario, record, figures);
    return {to_string(verdict.status), verdict.exit_code()};
  }
};

using Outcome = std::pair<std::string, int>;

TEST(Verdict, IsOkWhenEveryBoundHolds) {
  EXPECT_EQ(Case().judged(), Outcome("ok", 0));
  EXPECT_EQ(Case().expect_drift_at_most(0.5).judged(), Outcome("ok", 0));
  EXPECT_EQ(Case().expect_drift_at_most(0.4).judged(), Outcome("ok", 0));
}

TEST(Verdict, FailsWhenABoundDoesNotHold) {
  EXPECT_EQ(Case().expect_drift_at_most(0.3).judged(), Outcome("failed", 1));
  Case low;
  low.scenario.expect.push_back({"drift_percent", 0.5, std::nullopt});
  EXPECT_EQ(low.judged(), Outcome("failed", 1));
}

TEST(Verdict, ANullFigureHoldsNoBound) {
  Case unknown;
  unknown.scenario.expect.push_back({"map_rmse_m", std::nullopt, 1.0});
  EXPECT_EQ(unknown.judged(), Outcome("failed", 1));
}

TEST(Verdict, ErrorComesBeforeLostBeforeFailed) {
  EXPECT_EQ(Case().lost().judged(), Outcome("lost", 0));
  EXPECT_EQ(Case().lost().expect_drift_at_most(0.3).judged(), Outcome("lost", 1));
  EXPECT_EQ(Case().lost().fault().judged(), Outcome("error", 3));
  Case says_so;
  says_so.record.estimator_lost = true;
  EXPECT_EQ(says_so.judged(), Outcome("lost", 0));
}

TEST(Verdict, TheExpectedStatusIsACheck) {
  EXPECT_EQ(Case().expect_status("ok").judged(), Outcome("ok", 0));
  EXPECT_EQ(Case().lost().expect_status("ok").judged(), Outcome("lost", 1));
  EXPECT_EQ(Case().lost().expect_status("lost").judged(), Outcome("lost", 0));
  EXPECT_EQ(Case().expect_status("lost").judged(), Outcome("failed", 1));
  EXPECT_EQ(Case().fault().expect_status("error").judged(), Outcome("error", 0));
  EXPECT_EQ(Case().expect_drift_at_most(0.3).expect_status("failed").judged(), Outcome("failed", 0));
}

TEST(Verdict, EveryFigureThatAnExpectationMayNameIsOneOfResultJson) {
  RunFigures of_a_flight;  // which has them all
  of_a_flight.flight.emplace();
  std::set<std::string> keys;
  for (const Figure& figure : figure_list(of_a_flight)) keys.insert(figure.key);
  for (const std::string& name : result_figures()) EXPECT_EQ(keys.count(name), 1u) << name;
}

TEST(Verdict, DescribesABrokenBound) {
  const Verdict verdict = judge(Case().expect_drift_at_most(0.3).scenario, {}, Case().figures);
  EXPECT_EQ(describe(verdict.checks.at(0)), "drift_percent = 0.400, expected at most 0.300");
}

}  // namespace
}  // namespace plumbline
