#include "tests/proof/resampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tools/study/synthetic_suite.h"

namespace plumbline {
namespace {

using testing::synthetic_suite;

TEST(Resampling, BoundsAreClopperAndPearsons) {
  EXPECT_NEAR(upper_bound_95({0, 2000, 0}), 1.0 - std::pow(0.05, 1.0 / 2000.0), 1e-9);
  EXPECT_NEAR(upper_bound_95({10, 100, 0}), 0.1637, 1e-4);
  EXPECT_NEAR(lower_bound_95({10, 100, 0}), 0.0553, 1e-4);
  EXPECT_EQ(lower_bound_95({0, 100, 0}), 0.0);
  EXPECT_EQ(upper_bound_95({100, 100, 0}), 1.0);
}

TEST(Resampling, TellsAnUnchangedEstimatorFromAWorseOne) {
  const auto bank = synthetic_suite(24, "a");
  const FailureCount same = against_itself(bank, 8, 12);
  EXPECT_EQ(same.of, 12U);
  EXPECT_LE(same.failed, 1U);
  const FailureCount worse = against_each_other(bank, synthetic_suite(24, "b", 1.2), 8, 6);
  EXPECT_EQ(worse.failed, 6U);
  EXPECT_EQ(worse.by_main_figure, 6U);
}

TEST(Resampling, ABankTooSmallIsRefused) {
  EXPECT_THROW(against_itself(synthetic_suite(8, "a"), 8, 1), std::runtime_error);
}

}  // namespace
}  // namespace plumbline
