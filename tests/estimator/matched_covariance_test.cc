#include "estimator/pipeline/matched_covariance.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kStep_s = 0.1;
constexpr int kStepsPerMatch = 2;
const Pose kStep = {rotation_from_rpy({0.0, 0.0, 0.02}), {0.1, 0.0, 0.0}};
const Matrix6d kAdded = 1e-4 * Matrix6d::Identity();

/// A match that determines the last `determined` of the six directions, to 1 mm and 1 mrad.
SolveResult match_of(int determined) {
  SolveResult solved;
  solved.spectrum.well_conditioned = determined;
  solved.information.setIdentity();
  solved.information *= 1e6;
  return solved;
}

/// On a straight way, where directions of the body are those of the world.
MatchedCovariance after(int matches, int determined) {
  MatchedCovariance covariance;
  for (int match = 0; match < matches; ++match) {
    for (int step = 0; step < kStepsPerMatch; ++step) covariance.carry({}, kAdded, kStep_s);
    covariance.match(match_of(determined), {}, Eigen::Vector3d::Zero());
  }
  return covariance;
}

TEST(MatchedCovariance, OdometryAloneGathersItsSteps) {
  MatchedCovariance covariance;
  for (int step = 0; step < 30; ++step) covariance.carry(kStep, kAdded, kStep_s);
  // Turns add to what the place errs by, and nothing to what attitude does.
  const Vector6d variances = covariance.of_world().diagonal();
  EXPECT_NEAR(variances.head(3).sum(), 3 * 30 * 1e-4, 1e-9);
  EXPECT_GT(variances.tail(3).sum(), 3 * 30 * 1e-4);
  EXPECT_TRUE(covariance.per_s().isApprox(kAdded / kStep_s));
}

TEST(MatchedCovariance, AMatchMakesAnEndOfWhatOdometryHasGathered) {
  const MatchedCovariance covariance = after(20, 6);
  EXPECT_TRUE(covariance.of_world().isApprox(1e-6 * Matrix6d::Identity(), 1e-6));
  // Over a second both ends err by a match's noise, and by a step on average of what odometry adds.
  EXPECT_TRUE(covariance.per_s().isApprox(2.0 * (1e-6 + 1e-4) * Matrix6d::Identity(), 1e-6)) << covariance.per_s();
}

TEST(MatchedCovariance, WhatAMatchLeavesUndeterminedStays) {
  const MatchedCovariance covariance = after(20, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(covariance.of_world()(i, i), 20 * kStepsPerMatch * 1e-4, 1e-6);
    EXPECT_NEAR(covariance.per_s()(i, i), 1e-4 / kStep_s, 1e-9);
  }
  for (int i = 3; i < 6; ++i) {
    EXPECT_NEAR(covariance.of_world()(i, i), 1e-6, 1e-9);
    EXPECT_NEAR(covariance.per_s()(i, i), 2.0 * (1e-6 + 1e-4), 1e-9);
  }
}

TEST(MatchedCovariance, WithoutMatchesOdometryTellsHowThePoseGoesOn) {
  MatchedCovariance covariance = after(20, 6);
  for (int step = 0; step < 3 * kStepsPerMatch; ++step) covariance.carry({}, kAdded, kStep_s);
  EXPECT_TRUE(covariance.per_s().isApprox(kAdded / kStep_s));
  EXPECT_NEAR(covariance.of_world()(0, 0), 1e-6 + 3 * kStepsPerMatch * 1e-4, 1e-9);
}

TEST(MatchedCovariance, AMapThatIsRenewedDrifts) {
  MatchDrift drift;
  drift.reach_m = 10.0;
  MatchedCovariance covariance;
  for (int match = 0; match < 20; ++match) {
    covariance.carry({Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}}, kAdded, 1.0);
    covariance.match(match_of(6), drift, {1.0, 0.0, 0.0});
  }
  // Each metre a tenth of what is seen is new, and lies as wrongly as the match that placed it.
  EXPECT_NEAR(covariance.of_world()(0, 0), 1e-6 + 20 * 1e-7, 1e-9);
}

}  // namespace
}  // namespace plumbline
