#include "estimator/pipeline/lost_watch.h"

#include <gtest/gtest.h>

#include <limits>

namespace plumbline {
namespace {

Odometry at(double x_m, double sigma_m) {
  Odometry odometry;
  odometry.world_from_body.translation.x() = x_m;
  odometry.covariance = sigma_m * sigma_m / 3.0 * Matrix6d::Identity();
  return odometry;
}

/// Four kilometres of motorway end with 3 % of drift, and an estimator that knows it: that is odometry's lot.
TEST(LostWatch, DriftIsNotBeingLost) {
  LostWatch watch;
  for (double x_m = 0.0; x_m <= 4000.0; x_m += 0.1) EXPECT_FALSE(watch.lost(at(x_m, 0.03 * x_m))) << x_m;
}

TEST(LostWatch, UnsureByMoreThanTenMetresAndATenthOfTheWayIsLost) {
  LostWatch watch;
  EXPECT_FALSE(watch.lost(at(0.0, 9.0)));
  EXPECT_TRUE(watch.lost(at(0.0, 11.0)));
  for (double x_m = 0.0; x_m <= 1000.0; x_m += 0.5) watch.lost(at(x_m, 1.0));
  EXPECT_FALSE(watch.lost(at(1000.0, 95.0)));
  EXPECT_TRUE(watch.lost(at(1000.0, 105.0)));
}

/// A millimetre of noise at 200 Hz for three hours would be two kilometres.
TEST(LostWatch, NoiseIsNoWay) {
  LostWatch watch;
  for (int i = 0; i < 2'000'000; ++i) watch.lost(at(1e-3 * (i % 2), 1.0));
  EXPECT_TRUE(watch.lost(at(0.0, 11.0)));
}

TEST(LostWatch, WhatIsNoNumberIsLost) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(LostWatch().lost(at(kNoNumber, 1.0)));
  EXPECT_TRUE(LostWatch().lost(at(0.0, kNoNumber)));
}

}  // namespace
}  // namespace plumbline
