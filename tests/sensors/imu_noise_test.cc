#include "sensors/imu_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/catalogue.h"
#include "tools/verify/imu_check.h"

namespace plumbline {
namespace {

class CatalogueImu : public testing::TestWithParam<std::string> {};

TEST_P(CatalogueImu, LogsGiveBackItsFigures) {
  const ImuCheck check = check_imu(catalogue_imu(GetParam()), catalogue_names("imu").size(), 1);
  for (const TriadCheck* triad : {&check.gyro, &check.accel}) {
    EXPECT_LE(worst_error(triad->density, triad->figures.density), 0.03);
    EXPECT_LE(worst_error(triad->bias_instability, triad->figures.bias_instability), 0.10);
    EXPECT_LE(worst_error(triad->random_walk, triad->figures.random_walk), 0.10);
    EXPECT_EQ(share_within(*triad, triad->joint_band), 1.0);
    // 51 points or more, each inside its own band with 95 %: four standard deviations of their share, 3 % each.
    EXPECT_GE(share_within(*triad, triad->band), 0.83);
  }
}

INSTANTIATE_TEST_SUITE_P(Units, CatalogueImu, testing::ValuesIn(catalogue_names("imu")),
                         [](const auto& unit) { return "unit_" + unit.param; });

TEST(AllanModel, HasTheTextbooksSlopes) {
  const std::size_t log = 90'000;
  const AllanModel white({2.0, 0.0, 0.0}, 0.0, 25.0, log);
  EXPECT_NEAR(white.at(64).variance, 4.0 * 25.0 / 64.0, 1e-9);
  // 1.5 times the number of independent pairs, nearly: overlapping averages of white noise (NIST SP 1065, table 5).
  EXPECT_NEAR(white.at(64).degrees_of_freedom, 1.5 * log / 64.0, 0.02 * 1.5 * log / 64.0);
  const AllanModel walk({0.0, 0.0, 3.0}, 0.0, 25.0, log);
  EXPECT_NEAR(walk.at(256).variance, 9.0 * (256.0 / 25.0) / 3.0, 1e-3 * 9.0 * (256.0 / 25.0) / 3.0);
  const AllanModel flicker({0.0, 5.0, 0.0}, 0.0, 25.0, log);
  // The processes' band ends at 1 s, which still takes 1 % off at 100 s.
  EXPECT_NEAR(std::sqrt(flicker.at(2048).variance), 0.664 * 5.0, 0.01 * 0.664 * 5.0);
}

}  // namespace
}  // namespace plumbline
