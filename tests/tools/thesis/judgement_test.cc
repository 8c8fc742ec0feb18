#include "tools/thesis/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "tests/tools/thesis/experiment_text.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using Runs = std::vector<std::vector<std::optional<RunRow>>>;

constexpr double kNoFigure = -1.0;
constexpr double kNotRun = -2.0;

std::optional<RunRow> run_with(double drift) {
  if (drift == kNotRun) return std::nullopt;
  RunRow run;
  run.outcome = "finished";
  run.status = "ok";
  run.figures = {{"distance_m", "100.0"}};
  if (drift != kNoFigure) run.figures.emplace_back("drift_percent", fixed_text(drift, 4));
  return run;
}

Runs runs_of(const std::vector<std::vector<double>>& drifts) {
  Runs runs;
  for (const auto& of_configuration : drifts) {
    runs.emplace_back();
    for (const double drift : of_configuration) runs.back().push_back(run_with(drift));
  }
  return runs;
}

class JudgementTest : public ::testing::Test {
 protected:
  Judgement judged(const std::string& checks, const Runs& runs, const std::string& more = "") const {
    return judge(experiment_of(directory_, checks, more).front(), runs);
  }
  std::optional<bool> verdict(const std::string& checks, const std::vector<std::vector<double>>& drifts) const {
    return judged(checks, runs_of(drifts)).holds;
  }

  TemporaryDirectory directory_;
};

TEST_F(JudgementTest, BoundsAreOnMediansOfTheNamedConfigurations) {
  const std::vector<std::vector<double>> drifts = {{0.1, 0.2, 9.0}, {0.3, 0.3, 0.3}, {0.5, 0.5, 0.5}};
  EXPECT_EQ(verdict("{max: 0.2, of: [a]}", drifts), true);
  EXPECT_EQ(verdict("{max: 0.19, of: [a]}", drifts), false);
  EXPECT_EQ(verdict("{min: 0.2, max: 0.5}", drifts), true);
  EXPECT_EQ(verdict("{max: 0.4}", drifts), false) << "all configurations where none is named";
  EXPECT_EQ(verdict("{max: 0.2, of: [a]}, {max: 0.4, of: [c]}", drifts), false) << "every check has to hold";
}

TEST_F(JudgementTest, AnOrderNeedsGapsBeyondTheirIntervals) {
  EXPECT_EQ(verdict("{order: [a, b, c]}", {{1, 2, 3}, {2, 3, 4}, {4, 5, 6}}), true);
  EXPECT_EQ(verdict("{order: [b, a]}", {{1, 2, 3}, {2, 3, 4}, {4, 5, 6}}), false);
  // The medians are in order, but one seed in three says otherwise.
  EXPECT_EQ(verdict("{order: [a, b]}", {{1, 2, 3.5}, {2, 3, 3}, {0, 0, 0}}), false);
  EXPECT_EQ(verdict("{rising: [a, b]}", {{1, 2, 3.5}, {2, 3, 3}, {0, 0, 0}}), true);
  EXPECT_EQ(verdict("{rising: [a, b, c]}", {{1, 2, 3}, {1, 2, 3}, {1, 1, 3}}), false);
}

TEST_F(JudgementTest, RatiosAreTakenSeedBySeed) {
  const std::vector<std::vector<double>> drifts = {{1, 10, 100}, {5, 50, 600}, {1, 0, 1}};
  EXPECT_EQ(verdict("{ratio: [b, a], min: 5}", drifts), true);
  EXPECT_EQ(verdict("{ratio: [b, a], min: 5.1}", drifts), false);
  EXPECT_EQ(verdict("{ratio: [a, b], max: 0.21}", drifts), true);
  EXPECT_EQ(verdict("{ratio: [a, c], min: 1}", drifts), false) << "nothing is any number of times zero";
}

TEST_F(JudgementTest, WhatHasNotRunLeavesTheVerdictOpen) {
  const Judgement judgement = judged("{max: 1, of: [a]}, {max: 1, of: [b]}",
                                     runs_of({{0.1, 0.1, 0.1}, {0.1, kNotRun, kNotRun}, {0.1, 0.1, kNotRun}}));
  EXPECT_FALSE(judgement.holds);
  EXPECT_EQ(judgement.checks[0].holds, true);
  EXPECT_FALSE(judgement.checks[1].holds);
  EXPECT_EQ(judgement.seeds, 1U);
  EXPECT_THAT(judgement.note, HasSubstr("1 of 3 seeds run"));
  const Judgement nothing =
      judged("{max: 1}", runs_of(std::vector<std::vector<double>>(3, {kNotRun, kNotRun, kNotRun})));
  EXPECT_FALSE(nothing.holds);
  EXPECT_EQ(nothing.ours, "");
  EXPECT_EQ(nothing.note, "");
}

TEST_F(JudgementTest, ARunWithoutItsFigureDoesNotHold) {
  EXPECT_EQ(verdict("{max: 1, of: [a]}", {{0.1, kNoFigure, 0.1}, {1, 1, 1}, {1, 1, 1}}), false);
  // Nor does it prove that something else is better.
  EXPECT_EQ(verdict("{order: [b, a]}", {{2, kNoFigure, 2}, {1, 1, 1}, {1, 1, 1}}), false);
}

TEST_F(JudgementTest, OneLostRunDecidesThatNotAllAreOk) {
  Runs runs = runs_of({{0.1, 0.1, kNotRun}, {1, 1, 1}, {1, 1, 1}});
  EXPECT_FALSE(judged("{ok: 1, of: [a]}", runs).holds);
  runs[0][1]->status = "lost";
  const Judgement judgement = judged("{ok: 1, of: [a]}", runs);
  EXPECT_EQ(judgement.holds, false);
  EXPECT_THAT(judgement.checks[0].measured, HasSubstr("a 1 of 2"));
  EXPECT_THAT(judgement.note, HasSubstr("seed 2 lost"));
  EXPECT_FALSE(judged("{ok: 0.6, of: [a]}", runs).holds) << "two of three can still be";
}

TEST_F(JudgementTest, AShorterPathSaysSoAndDoesNotCountAsHolding) {
  const Runs runs = runs_of({{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}});
  EXPECT_EQ(judged("{max: 1}", runs, ", length_m: 101").holds, true);
  const Judgement shorter = judged("{max: 1}", runs, ", length_m: 200");
  EXPECT_FALSE(shorter.holds);
  EXPECT_THAT(shorter.note, HasSubstr("100 m of the thesis's 200 m"));
  EXPECT_EQ(judged("{max: 0.01}", runs, ", length_m: 200").holds, false);
}

TEST_F(JudgementTest, OursAndSpreadAreTextsWithUnits) {
  const Judgement judgement = judged("{max: 1}", runs_of({{0.1, 0.3, 0.2}, {2, 2, 2}, {kNoFigure, 1, kNotRun}}));
  EXPECT_EQ(judgement.ours, "a 0.200 %, b 2.00 %, c 1.00 %");
  EXPECT_EQ(judgement.spread, "a 0.100 … 0.300 %, b 2.00 … 2.00 %, c 1.00 … 1.00 %");
  ASSERT_EQ(judgement.figures.size(), 3U);
  EXPECT_THAT(judgement.figures[0].values, ::testing::ElementsAre(0.1, 0.3, 0.2));
}

TEST_F(JudgementTest, TablesThatMakeNoSenseAreRefused) {
  const auto refused = [&](const std::string& checks, const std::string& more = "") {
    EXPECT_THROW(experiment_of(directory_, checks, more), InputError) << checks << more;
  };
  refused("{max: 1, of: [d]}");
  refused("{order: [a]}");
  refused("{order: [a, b], max: 1}");
  refused("{order: [a, b], rising: [a, b]}");
  refused("{ratio: [a, b, c], min: 1}");
  refused("{ratio: [a, b]}");
  refused("{ok: 1.5}");
  refused("{ok: 1, max: 2}");
  refused("{figure: drift_percent}");
  refused("");
  refused("{max: 1}", ", lenght_m: 3");
  refused("{max: 1}", "}, {id: row");
}

}  // namespace
}  // namespace plumbline
