#include "estimator/vision/motion_constraints.h"

#include <gtest/gtest.h>

#include <vector>

#include "estimator/geometry/so3.h"
#include "estimator/solver/robust_solver.h"
#include "sim/random_stream.h"
#include "tests/support/jacobian_check.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

const CameraIntrinsics kUnevenCamera{640, 360, 474.0, 470.0, 319.5, 179.5};
const Pose kBodyFromTilted{body_from_optical_rotation() * exp_so3({0.02, -0.03, 0.01}), Vector3d(0.12, -0.03, 0.05)};

std::vector<Pose> poses() {
  return {Pose{},
          {exp_so3({1e-7, -2e-7, 1e-7}), Vector3d(1e-6, 2e-6, -1e-6)},
          {exp_so3({0.003, -0.002, 0.004}), Vector3d(0.004, -0.002, 0.001)},
          {exp_so3({0.1, -0.15, 0.2}), Vector3d(0.5, -0.3, 0.2)}};
}

FeatureSighting sighting(InverseDepth depth) {
  FeatureSighting feature;
  feature.keyframe_ray = ray_through(kUnevenCamera, {420.0, 80.0});
  feature.pixel = {405.0, 95.0};
  feature.pixel_sigma = 0.3;
  feature.depth = depth;
  return feature;
}

TEST(ReprojectionRows, JacobianMatchesCentralDifferencesForFixedWhitening) {
  for (const InverseDepth& depth : {InverseDepth{0.2, 0.001}, InverseDepth{0.5, 0.1}, InverseDepth{0.0, 0.3}}) {
    const FeatureSighting feature = sighting(depth);
    for (const Pose& pose : poses()) {
      const CameraMotion motion = camera_motion(pose, kBodyFromTilted);
      const Eigen::Matrix2d whitening = reprojection_whitening(motion, kUnevenCamera, feature);
      const PixelRows rows = reprojection_rows(motion, kUnevenCamera, feature, whitening);
      for (int i = 0; i < 2; ++i) {
        const auto residual = [&](const Pose& p) {
          return reprojection_rows(camera_motion(p, kBodyFromTilted), kUnevenCamera, feature, whitening).residual[i];
        };
        testing::expect_jacobian_near(residual, pose, rows.jacobian.row(i));
      }
    }
  }
}

TEST(EpipolarRow, JacobianMatchesCentralDifferences) {
  const FeatureSighting feature = sighting({});
  for (const Pose& pose : poses()) {
    const PixelRow row = epipolar_row(camera_motion(pose, kBodyFromTilted), kUnevenCamera, feature);
    const auto residual = [&](const Pose& p) {
      return epipolar_row(camera_motion(p, kBodyFromTilted), kUnevenCamera, feature).residual;
    };
    // Within micrometres of no motion the row bends over its 1 mm floor: differences with a step of 1e-5 see
    // (1e-5 / 1e-3)^2 of that.
    testing::expect_jacobian_near(residual, pose, row.jacobian, 1e-4);
  }
}

TEST(EpipolarRow, IsFiniteAndSilentWithoutMotion) {
  const PixelRow row = epipolar_row(camera_motion(Pose{}, kBodyFromTilted), kUnevenCamera, sighting({}));
  EXPECT_NEAR(row.residual, 0.0, 1e-9);  // rounding of the extrinsics' inverse over the 1 mm floor
  EXPECT_TRUE(row.jacobian.allFinite());
}

TEST(EpipolarRow, IsThePixelDistanceFromTheEpipolarLine) {
  // The camera moves along its own x axis: epipolar lines are image rows, so 3 px of vertical offset are 3 px.
  const Pose body_from_camera{body_from_optical_rotation(), Vector3d::Zero()};
  const Pose keyframe_from_body{Eigen::Quaterniond::Identity(), Vector3d(0.0, -0.4, 0.0)};
  FeatureSighting feature = sighting({});
  feature.pixel = {380.0, 83.0};
  feature.pixel_sigma = 1.0;
  const PixelRow row = epipolar_row(camera_motion(keyframe_from_body, body_from_camera), kUnevenCamera, feature);
  EXPECT_NEAR(std::abs(row.residual), 3.0, 1e-4);  // the floor of 1 mm beside 400 mm: 3e-6
}

TEST(ReprojectionRows, DepthUncertaintyActsAlongTheEpipolarLineOnly) {
  const Pose body_from_camera{body_from_optical_rotation(), Vector3d::Zero()};
  const Pose keyframe_from_body{Eigen::Quaterniond::Identity(), Vector3d(0.0, -0.4, 0.0)};  // lines are image rows
  const CameraMotion motion = camera_motion(keyframe_from_body, body_from_camera);
  const Eigen::Matrix2d whitening = reprojection_whitening(motion, kUnevenCamera, sighting({0.2, 0.05}));
  EXPECT_NEAR(whitening(1, 1), 1.0 / 0.3, 1e-9);
  EXPECT_NEAR(whitening(0, 0), 1.0 / std::hypot(0.3, 474.0 * 0.4 * 0.05), 1e-9);
}

TEST(ReprojectionRows, APointBehindTheCameraIsAnOutlierWithoutGradient) {
  const Pose keyframe_from_body{Eigen::Quaterniond::Identity(), Vector3d(10.0, 0.0, 0.0)};
  const CameraMotion motion = camera_motion(keyframe_from_body, kBodyFromTilted);
  const FeatureSighting feature = sighting({0.2, 0.001});
  const Eigen::Matrix2d whitening = reprojection_whitening(motion, kUnevenCamera, feature);
  const PixelRows rows = reprojection_rows(motion, kUnevenCamera, feature, whitening);
  EXPECT_TRUE(rows.residual.allFinite());
  EXPECT_GT(rows.residual.norm(), 100.0);
  EXPECT_TRUE(rows.jacobian.isZero());
}

/// Features drawn over the view at 3-15 m with pixel noise; two thirds know their depth to 2 cm, the rest not at all.
std::vector<FeatureSighting> noisy_sightings(const Pose& keyframe_from_body, RandomStream& random) {
  const CameraMotion motion = camera_motion(keyframe_from_body, kBodyFromTilted);
  std::vector<FeatureSighting> features;
  for (int i = 0; i < 120; ++i) {
    FeatureSighting f;
    f.keyframe_ray = ray_through(kUnevenCamera, {random.uniform(40, 600), random.uniform(40, 320)});
    const double depth = random.uniform(3.0, 15.0);
    const Vector3d point =
        motion.camera_from_keyframe_rotation * (depth * f.keyframe_ray) + motion.camera_from_keyframe_translation;
    f.pixel = project(kUnevenCamera, point) + f.pixel_sigma * Eigen::Vector2d(random.gaussian(), random.gaussian());
    if (i % 3 != 0) f.depth = {1.0 / depth + 0.02 / (depth * depth) * random.gaussian(), 0.02 / (depth * depth)};
    features.push_back(f);
  }
  return features;
}

SolveResult solve_sightings(const std::vector<FeatureSighting>& features, const Pose& guess) {
  const CameraMotion at_guess = camera_motion(guess, kBodyFromTilted);
  const auto linearize = [&](const Pose& pose, ResidualRows& rows) {
    const CameraMotion motion = camera_motion(pose, kBodyFromTilted);
    for (const FeatureSighting& f : features) {
      if (!f.depth.known()) {
        const PixelRow row = epipolar_row(motion, kUnevenCamera, f);
        rows.add(row.residual, row.jacobian);
      } else {
        const PixelRows pair =
            reprojection_rows(motion, kUnevenCamera, f, reprojection_whitening(at_guess, kUnevenCamera, f));
        rows.add(pair.residual[0], pair.jacobian.row(0), pair.residual[1], pair.jacobian.row(1));
      }
    }
  };
  return solve(guess, std::nullopt, linearize, SolverOptions{});
}

TEST(MotionConstraints, InformationIsTheInverseOfTheErrorsCovariance) {
  RandomStream random(3, "nees");
  const Pose truth{exp_so3({0.01, -0.02, 0.03}), Vector3d(0.3, 0.1, -0.05)};
  constexpr int kTrials = 200;
  double sum = 0.0;
  Vector6d mean_error = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
  for (int i = 0; i < kTrials; ++i) {
    const auto features = noisy_sightings(truth, random);
    const Vector6d away = (Vector6d() << 0.002, -0.001, 0.002, 0.01, -0.01, 0.01).finished();
    const SolveResult result = solve_sightings(features, truth.retract(away));
    ASSERT_EQ(result.spectrum.well_conditioned, 6);
    const Vector6d error = truth.local(result.pose);
    sum += error.dot(result.information * error) / 6.0;
    mean_error += error / kTrials;
    information = result.information;
  }
  // Bisquare weights (mean about 0.9 on Gaussian noise, squared effect on the error's covariance) move this a little
  // from 1; the mean of 200 draws of chi2_6 / 6 has a standard deviation of 0.04.
  EXPECT_GT(sum / kTrials, 0.75);
  EXPECT_LT(sum / kTrials, 1.25);
  // Unbiased: the mean of 200 errors is 200 times more certain; chi2_6 exceeds 22.5 once in 1000.
  EXPECT_LT(kTrials * mean_error.dot(information * mean_error), 22.5);
}

}  // namespace
}  // namespace plumbline
