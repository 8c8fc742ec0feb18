#include "tools/study/comparison.h"

#include <gtest/gtest.h>

#include "tests/tools/study/synthetic_suite.h"

namespace plumbline {
namespace {

using testing::synthetic_suite;

Comparison compare(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after) {
  return compare_runs(before, after, {}, /*same_machine=*/true);
}

/// Other seeds under the same numbers: the hardest case of no change.
std::vector<MeasuredRun> renumbered(std::vector<MeasuredRun> runs, std::uint64_t less) {
  for (MeasuredRun& run : runs) run.seed -= less;
  return runs;
}

TEST(Comparison, TheSameRunsNeverFail) {
  const auto runs = synthetic_suite(8, "a");
  const Comparison comparison = compare(runs, runs);
  EXPECT_TRUE(comparison.passes());
  EXPECT_EQ(comparison.pairs.size(), 48U);
  EXPECT_EQ(comparison.changes.front().percent.value, 0.0);
}

TEST(Comparison, OtherSeedsOfTheSameEstimatorHardlyEverFail) {
  int failed = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const auto before = synthetic_suite(8, "a", 1.0, 1.0, 1 + 20 * trial);
    const auto after = renumbered(synthetic_suite(8, "a", 1.0, 1.0, 9 + 20 * trial), 8);
    failed += compare(before, after).passes() ? 0 : 1;
  }
  // At 0.5 % one of 6 would happen once in 33 times, two hardly ever.
  EXPECT_LE(failed, 1);
}

TEST(Comparison, TenPercentMoreErrorIsCaught) {
  int caught = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const auto before = synthetic_suite(8, "a", 1.0, 1.0, 1 + 20 * trial);
    caught += compare(before, synthetic_suite(8, "b", 1.10, 1.0, 1 + 20 * trial)).changes.front().worse ? 1 : 0;
  }
  EXPECT_EQ(caught, 4);
}

TEST(Comparison, TwiceTheDriftIsCaughtByTheDrift) {
  int caught = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const auto before = synthetic_suite(8, "a", 1.0, 1.0, 1 + 20 * trial);
    const Comparison comparison = compare(before, synthetic_suite(8, "b", 1.0, 2.0, 1 + 20 * trial));
    EXPECT_FALSE(comparison.changes[0].worse);
    caught += comparison.changes[2].figure->key == "drift" && comparison.changes[2].worse ? 1 : 0;
  }
  EXPECT_EQ(caught, 4);
}

TEST(Comparison, AClearChangeSmallerThanTheEffectPasses) {
  const auto before = synthetic_suite(8, "a");
  const Comparison comparison = compare(before, synthetic_suite(8, "a", 1.03));
  EXPECT_LT(comparison.changes.front().p_worse, 1e-3);
  EXPECT_TRUE(comparison.passes());
  EXPECT_FALSE(compare_runs(before, synthetic_suite(8, "a", 1.03), Effects{{{"relative_error", 2.0}}}, true).passes());
}

TEST(Comparison, WhatBecameBetterIsNoFailure) {
  const Comparison comparison = compare(synthetic_suite(8, "a"), synthetic_suite(8, "a", 0.8));
  EXPECT_TRUE(comparison.passes());
  EXPECT_TRUE(comparison.changes.front().better);
}

TEST(Comparison, OneScenarioThatBreaksIsNamed) {
  auto after = synthetic_suite(8, "b");
  for (MeasuredRun& run : after) {
    if (run.scenario == "tunnel") testing::worsen(run, 2.0);
  }
  const Comparison comparison = compare(synthetic_suite(8, "a"), after);
  for (const Change& change : comparison.changes) {
    if (change.scenario.empty()) continue;
    EXPECT_EQ(change.worse, change.figure->key == "relative_error" && change.scenario == "tunnel")
        << change.figure->key << " " << change.scenario << " " << change.percent.value;
  }
}

TEST(Comparison, AnErrorIsNoMatterOfChance) {
  auto after = synthetic_suite(8, "a");
  after[3].status = "error";
  after[3].relative_error_by_second_m.clear();
  const auto before = synthetic_suite(8, "a");
  const Comparison comparison = compare(before, after);
  EXPECT_FALSE(comparison.passes());
  ASSERT_EQ(comparison.without_result.size(), 1U);
  EXPECT_EQ(comparison.without_result.front().after->seed, 4U);
}

TEST(Comparison, AFewLostRunsAreChanceAndManyAreNot) {
  const auto before = synthetic_suite(8, "a");
  auto after = before;
  after[0].status = after[1].status = "lost";
  EXPECT_TRUE(compare(before, after).passes());
  for (std::size_t i = 0; i < 16; ++i) after[i].status = "lost";
  EXPECT_TRUE(compare(before, after).status.worse);
}

TEST(Comparison, AnotherMachinesTimeIsOnlyShown) {
  auto after = synthetic_suite(8, "a");
  for (MeasuredRun& run : after) *run.estimator_time_ratio *= 3.0;
  EXPECT_FALSE(compare(synthetic_suite(8, "a"), after).passes());
  EXPECT_TRUE(compare_runs(synthetic_suite(8, "a"), after, {}, /*same_machine=*/false).passes());
}

TEST(Comparison, StatesWhatItCouldDetect) {
  const auto before = synthetic_suite(8, "a");
  const auto after = synthetic_suite(8, "b");
  const Comparison comparison = compare(before, after);
  const std::vector<double> unpaired = detectable_unpaired_percent(comparison);
  ASSERT_EQ(unpaired.size(), comparison.changes.size());
  // A pair scatters by 0.085: 48 of them give 1.2 %, times 1.645 beyond the effect of 4 %, or 3.1 + 1.6 beyond nothing.
  EXPECT_NEAR(comparison.changes.front().detectable_percent, 6.1, 1.5);
  EXPECT_GT(unpaired.front(), 2.0 * comparison.changes.front().detectable_percent);
}

TEST(Comparison, FewPairsDetectNothing) {
  const auto three = synthetic_suite(2, "a");
  const Comparison comparison = compare({three[0], three[1]}, {three[0], three[1]});
  EXPECT_TRUE(comparison.passes());
  EXPECT_TRUE(compare({}, {}).passes());
}

}  // namespace
}  // namespace plumbline
