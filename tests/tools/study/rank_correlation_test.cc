#include "tools/study/rank_correlation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

TEST(Spearman, IsOneForAnyRisingAndMinusOneForAnyFallingRelation) {
  const std::vector<double> x = {1, 2, 3, 10, 20};
  EXPECT_DOUBLE_EQ(*spearman(x, {0.1, 0.2, 5, 6, 1e6}), 1.0);
  EXPECT_DOUBLE_EQ(*spearman(x, {5, 4, 3, 2, 1}), -1.0);
}

TEST(Spearman, GivesTiesTheirMeanRank) {
  // Ranks 0, 1.5, 1.5, 3 against 0, 1, 2, 3: Pearson's of those.
  EXPECT_NEAR(*spearman({1, 2, 2, 3}, {1, 2, 3, 4}), 4.5 / std::sqrt(4.5 * 5.0), 1e-12);
}

TEST(Spearman, SaysNothingOfTooFewPairsOrOfOneThatNeverChanges) {
  EXPECT_FALSE(spearman({1, 2}, {1, 2}));
  EXPECT_FALSE(spearman({1, 1, 1}, {1, 2, 3}));
}

TEST(BootstrapSpearman, HoldsTheValueWithinItsInterval) {
  const auto interval = bootstrap_spearman({1, 2, 3, 4, 5, 6, 7, 8}, {1, 3, 2, 4, 6, 5, 8, 7}, "test");
  ASSERT_TRUE(interval);
  EXPECT_LE(interval->low, interval->value);
  EXPECT_GE(interval->high, interval->value);
  EXPECT_GT(interval->low, 0.3);
}

TEST(SplitHalfCeiling, IsNearOneForThingsFarApartAndNearZeroForOneAndTheSame) {
  RandomStream noise(1, "samples");
  std::vector<std::vector<double>> apart;
  std::vector<std::vector<double>> alike;
  for (int thing = 0; thing < 40; ++thing) {
    apart.emplace_back();
    alike.emplace_back();
    for (int i = 0; i < 6; ++i) {
      apart.back().push_back(thing + 0.01 * noise.gaussian());
      alike.back().push_back(noise.gaussian());
    }
  }
  EXPECT_NEAR(*split_half_ceiling(apart, "test"), 1.0, 1e-9);
  EXPECT_LT(std::abs(*split_half_ceiling(alike, "test")), 0.35);  // 40 things: 1 / sqrt(39), raised, twice
  EXPECT_FALSE(split_half_ceiling({{1}, {2}, {3}}, "test"));
}

}  // namespace
}  // namespace plumbline
