#include "tools/study/paired_bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

PairedStrata drawn(std::size_t scenarios, std::size_t seeds, const std::function<double()>& draw) {
  PairedStrata strata(scenarios);
  for (auto& stratum : strata) {
    for (std::size_t i = 0; i < seeds; ++i) stratum.push_back(draw());
  }
  return strata;
}

/// How often the test says "grown" at a level, of so many trials.
double rate_above(double level, std::size_t scenarios, std::size_t seeds, const std::function<double()>& draw) {
  constexpr int kTrials = 40;
  int above = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    above += paired_bootstrap(drawn(scenarios, seeds, draw), "test").p_above <= level ? 1 : 0;
  }
  return static_cast<double>(above) / kTrials;
}

TEST(PairedBootstrap, KeepsItsLevelForGaussiansAndForEndPoints) {
  RandomStream draws(3, "test");
  const auto end_point = [&] { return std::log(std::hypot(draws.gaussian(), draws.gaussian(), draws.gaussian())); };
  // Three standard deviations of 40 trials at 10 % are 14 %.
  EXPECT_LE(rate_above(0.1, 6, 8, [&] { return 0.3 * draws.gaussian(); }), 0.24);
  EXPECT_LE(rate_above(0.1, 6, 8, [&] { return end_point() - end_point(); }), 0.24);
}

TEST(PairedBootstrap, FindsAShiftOfThreeStandardErrors) {
  RandomStream draws(4, "test");
  // 48 pairs: a standard error of 0.0433; power at the level 0.05 is P(z > 1.645 - 3.5) = 97 %.
  EXPECT_GE(rate_above(0.05, 6, 8, [&] { return 0.15 + 0.3 * draws.gaussian(); }), 0.9);
}

TEST(PairedBootstrap, TheIntervalHoldsTheMeanAndP) {
  const PairedMean mean = paired_bootstrap({{0.1, 0.2, 0.3, 0.25}, {0.0, 0.1, 0.05, 0.15}}, "test");
  EXPECT_NEAR(mean.mean.value, 0.5 * (0.2125 + 0.075), 1e-12);
  EXPECT_EQ(mean.pairs, 8U);
  EXPECT_LT(mean.mean.low, mean.mean.value);
  EXPECT_GT(mean.mean.high, mean.mean.value);
  EXPECT_LT(mean.p_above, 0.01);
  EXPECT_GT(mean.p_below, 0.9);
}

TEST(PairedBootstrap, NoChangeAtAllIsNoFinding) {
  const PairedMean mean = paired_bootstrap({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, "test");
  EXPECT_EQ(mean.mean.low, 0.0);
  EXPECT_EQ(mean.mean.high, 0.0);
  EXPECT_EQ(mean.p_above, 1.0);
}

TEST(PairedBootstrap, TheSameShiftEverywhereIsClear) {
  EXPECT_LT(paired_bootstrap({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, "test").p_above, 1e-4);
}

TEST(PairedBootstrap, TwoSeedsProveNothing) {
  const PairedMean mean = paired_bootstrap({{0.5, 0.6}}, "test");
  EXPECT_GT(mean.p_above, 0.1);
  EXPECT_TRUE(std::isinf(critical_value(mean, 0.001)));
  EXPECT_EQ(paired_bootstrap({{0.5}, {}}, "test").pairs, 0U);
}

TEST(SignTest, IsTheBinomialTail) {
  EXPECT_NEAR(sign_test(5, 5), 1.0 / 32.0, 1e-12);
  EXPECT_NEAR(sign_test(4, 5), 6.0 / 32.0, 1e-12);
  EXPECT_EQ(sign_test(0, 0), 1.0);
}

TEST(Holm, SharesTheLevelByWeightAndPassesOnWhatIsLeft) {
  // Equal weights: 0.01 <= 0.05/3, then 0.02 <= 0.05/2, then 0.06 > 0.05.
  EXPECT_EQ(holm({{0.06, 1}, {0.01, 1}, {0.02, 1}}, 0.05), (std::vector<bool>{false, true, true}));
  // The first fails: so do all the others.
  EXPECT_EQ(holm({{0.02, 1}, {0.02, 1}, {0.03, 1}}, 0.05), (std::vector<bool>{false, false, false}));
  // Four fifths of the level belong to the first.
  EXPECT_EQ(holm({{0.03, 8}, {0.03, 2}}, 0.05), (std::vector<bool>{true, true}));
  EXPECT_EQ(holm({{0.045, 8}, {0.03, 2}}, 0.05), (std::vector<bool>{false, false}));
}

}  // namespace
}  // namespace plumbline
