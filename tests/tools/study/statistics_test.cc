#include "tools/study/statistics.h"

#include <gtest/gtest.h>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

/// Newcombe, Statistics in Medicine 17 (1998), table I: Wilson's interval for 81 of 263 and for 0 of 20.
TEST(Wilson, AgreesWithPublishedIntervals) {
  const Interval many = wilson_interval(81, 263);
  EXPECT_NEAR(many.low, 0.2553, 5e-5);
  EXPECT_NEAR(many.high, 0.3662, 5e-5);
  const Interval none = wilson_interval(0, 20);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.1611, 5e-5);
}

TEST(Wilson, AllOfAFewLeavesRoomForFailure) {
  const Interval all = wilson_interval(3, 3);
  EXPECT_EQ(all.value, 1.0);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_LT(all.low, 0.5);
}

TEST(BootstrapMedian, CoversTheTrueMedianAsOftenAsItSays) {
  RandomStream draws(5, "test");
  int covered = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values;
    for (int i = 0; i < 30; ++i) values.push_back(draws.gaussian());
    const Interval interval = *bootstrap_median(values, "coverage");
    covered += interval.low <= 0.0 && interval.high >= 0.0 ? 1 : 0;
  }
  // 95 % nominal; three standard deviations of 200 trials are 4.6 %.
  EXPECT_GE(covered, static_cast<int>(0.90 * kTrials));
}

TEST(BootstrapMedian, IsTheSameEveryTime) {
  const std::vector<double> values{3.0, 1.0, 4.0, 1.5, 9.0};
  const Interval first = *bootstrap_median(values, "x");
  const Interval second = *bootstrap_median(values, "x");
  EXPECT_EQ(first.value, 3.0);
  EXPECT_EQ(first.low, second.low);
  EXPECT_EQ(first.high, second.high);
  EXPECT_FALSE(bootstrap_median({}, "x").has_value());
}

}  // namespace
}  // namespace plumbline
