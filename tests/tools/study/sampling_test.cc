#include "tools/study/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace plumbline {
namespace {

TEST(Sobol, BeginsAsTheSequenceIsPublished) {
  const UnitPoints points = sobol_points(4, 3);
  const UnitPoints published{{0.5, 0.5, 0.5}, {0.75, 0.25, 0.25}, {0.25, 0.75, 0.75}, {0.375, 0.375, 0.625}};
  for (std::size_t i = 0; i < published.size(); ++i) EXPECT_EQ(points[i], published[i]) << i;
}

/// With the corner that is left out, each of the first 2^k points of each coordinate lies in an interval of its own:
/// what a wrong direction number breaks first.
TEST(Sobol, EveryCoordinateFillsEveryDyadicInterval) {
  constexpr std::size_t kPoints = 256;
  const UnitPoints points = sobol_points(kPoints - 1, kSobolDimensions);
  for (std::size_t d = 0; d < kSobolDimensions; ++d) {
    std::set<int> cells{0};
    for (const auto& point : points) cells.insert(static_cast<int>(point[d] * kPoints));
    EXPECT_EQ(cells.size(), kPoints) << "dimension " << d;
  }
}

/// The mean of a smooth product over the cube converges much faster than with independent points, whose error would
/// be about 1/sqrt(1024) = 3 % of the integrand's spread.
TEST(Sobol, IntegratesBetterThanChance) {
  constexpr std::size_t kDimensions = 8;
  const UnitPoints points = sobol_points(1023, kDimensions);
  double sum = 0.0;
  for (const auto& point : points) {
    double product = 1.0;
    for (const double x : point) product *= 1.0 + 0.5 * (x - 0.5);
    sum += product;
  }
  EXPECT_NEAR(sum / 1023.0, 1.0, 0.003);
}

TEST(Sobol, RefusesMoreDimensionsThanItKnows) {
  EXPECT_THROW(sobol_points(4, kSobolDimensions + 1), std::invalid_argument);
}

TEST(LatinHypercube, TakesEveryStratumOfEveryCoordinateOnce) {
  constexpr std::size_t kPoints = 37;
  const UnitPoints points = latin_hypercube(kPoints, {"a", "b"});
  for (std::size_t d = 0; d < 2; ++d) {
    std::set<int> strata;
    for (const auto& point : points) strata.insert(static_cast<int>(point[d] * kPoints));
    EXPECT_EQ(strata.size(), kPoints);
  }
}

TEST(LatinHypercube, AnotherCoordinateChangesNoneThatWasThere) {
  const UnitPoints alone = latin_hypercube(10, {"b"});
  const UnitPoints beside = latin_hypercube(10, {"a", "b"});
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(alone[i][0], beside[i][1]);
}

}  // namespace
}  // namespace plumbline
