#include <gtest/gtest.h>

#include <numbers>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/pose.h"
#include "estimator/geometry/so3.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

Eigen::Vector3d random_vector(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Pose random_pose(RandomStream& random) { return {exp_so3(random_vector(random, 1.5)), random_vector(random, 20.0)}; }

/// Rotation vectors on both sides of the series' switch at 1e-4 rad, and up to nearly half a turn.
std::vector<Eigen::Vector3d> rotation_vectors() {
  std::vector<Eigen::Vector3d> vectors = {Eigen::Vector3d::Zero()};
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();
  for (const double angle : {1e-9, 0.99e-4, 1.01e-4, 1.9e-4, 2.1e-4, 0.1, 1.0, 3.0, std::numbers::pi - 1e-6}) {
    vectors.emplace_back(angle * axis);
  }
  return vectors;
}

TEST(So3, ExpMatchesAngleAxis) {
  for (const Eigen::Vector3d& v : rotation_vectors()) {
    const double angle = v.norm();
    const Eigen::Vector3d axis = angle > 0.0 ? (v / angle).eval() : Eigen::Vector3d::UnitX().eval();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((exp_so3(v).toRotationMatrix() - expected).norm(), 1e-14) << v.transpose();
  }
}

TEST(So3, LogInvertsExp) {
  for (const Eigen::Vector3d& v : rotation_vectors())
    EXPECT_LT((log_so3(exp_so3(v)) - v).norm(), 1e-9) << v.transpose();
}

TEST(So3, LogTakesTheShortWayForEitherSignOfTheQuaternion) {
  const Eigen::Vector3d v(0.2, -0.1, 0.4);
  Eigen::Quaterniond negated = exp_so3(v);
  negated.coeffs() *= -1.0;
  EXPECT_LT((log_so3(negated) - v).norm(), 1e-14);
}

TEST(So3, SkewIsTheCrossProduct) {
  const Eigen::Vector3d a(1.0, -2.0, 3.0);
  const Eigen::Vector3d b(0.5, 4.0, -1.0);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(So3, RightJacobianIsTheDerivativeOfExp) {
  constexpr double kStep = 1e-6;  // central differences: error O(step^2) plus rounding 1e-16 / step
  for (const Eigen::Vector3d& v : rotation_vectors()) {
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      numeric.col(i) =
          (log_so3(exp_so3(v).conjugate() * exp_so3(v + d)) - log_so3(exp_so3(v).conjugate() * exp_so3(v - d))) /
          (2.0 * kStep);
    }
    EXPECT_LT((numeric - right_jacobian_so3(v)).norm(), 1e-8) << v.transpose();
  }
}

TEST(Pose, ComposesLikeItActs) {
  RandomStream random(1, "pose");
  for (int k = 0; k < 20; ++k) {
    const Pose a = random_pose(random);
    const Pose b = random_pose(random);
    const Eigen::Vector3d p = random_vector(random, 50.0);
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
    EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-12);
  }
}

TEST(Pose, LocalInvertsRetract) {
  RandomStream random(2, "pose");
  for (int k = 0; k < 20; ++k) {
    const Pose a = random_pose(random);
    Vector6d d;
    d << random_vector(random, 1.0), random_vector(random, 5.0);
    EXPECT_LT((a.local(a.retract(d)) - d).norm(), 1e-12);
  }
}

TEST(Pose, PerturbationIsInTheBodyFrame) {
  const Pose facing_left = {rotation_from_rpy({0.0, 0.0, 0.5 * std::numbers::pi}), {1.0, 2.0, 3.0}};
  Vector6d forward = Vector6d::Zero();
  forward[3] = 1.0;
  EXPECT_LT((facing_left.retract(forward).translation - Eigen::Vector3d(1.0, 3.0, 3.0)).norm(), 1e-14);
}

TEST(Pose, AdjointMovesAPerturbationThroughATransform) {
  RandomStream random(3, "pose");
  const Pose t = random_pose(random);
  Vector6d d;
  d << 1e-6, -2e-6, 1e-6, 3e-6, 1e-6, -2e-6;  // first order: errs by |d|^2 times the 20 m lever
  const Pose through = Pose{}.retract(adjoint(t) * d) * t;
  EXPECT_LT(t.local(through * t.retract(d).inverse() * t).norm(), 1e-9);
}

TEST(Pose, RollPitchYawRoundTripsAndPositivePitchLooksDown) {
  const Eigen::Vector3d rpy(0.1, -0.7, 2.5);
  EXPECT_LT((rpy_from_rotation(rotation_from_rpy(rpy)) - rpy).norm(), 1e-14);
  EXPECT_LT((rotation_from_rpy({0.0, 0.3, 0.0}) * Eigen::Vector3d::UnitX()).z(), 0.0);
}

TEST(Pose, OpticalAxesMapToBodyAxes) {
  const Eigen::Quaterniond body_from_optical = body_from_optical_rotation();
  EXPECT_LT((body_from_optical * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((body_from_optical * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((body_from_optical * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(Interpolation, KeepsItsEndsAndTurnsAtAConstantRate) {
  RandomStream random(4, "pose");
  const Pose a = random_pose(random);
  const Pose b = random_pose(random);
  EXPECT_LT(a.local(interpolate(a, b, 0.0)).norm(), 1e-12);
  EXPECT_LT(b.local(interpolate(a, b, 1.0)).norm(), 1e-12);
  const Vector6d whole = a.local(b);
  const Vector6d third = a.local(interpolate(a, b, 1.0 / 3.0));
  EXPECT_LT((third - whole / 3.0).norm(), 1e-12);
}

TEST(PoseTrack, ReadsBetweenItsStampsAndHoldsItsEnds) {
  PoseTrack track;
  EXPECT_THROW(track.at(0), std::out_of_range);
  for (int k = 0; k < 4; ++k) track.push(100 * k, {Eigen::Quaterniond::Identity(), {1.0 * k * k, 0.0, 0.0}});
  EXPECT_THROW(track.push(300, {}), std::invalid_argument);
  EXPECT_NEAR(track.at(250).translation.x(), 6.5, 1e-12);
  EXPECT_NEAR(track.at(200).translation.x(), 4.0, 1e-12);
  EXPECT_NEAR(track.at(-5).translation.x(), 0.0, 1e-12);
  EXPECT_NEAR(track.at(1000).translation.x(), 9.0, 1e-12);
  track.forget_before(250);
  EXPECT_TRUE(track.covers(250));
  EXPECT_FALSE(track.covers(150));
  EXPECT_NEAR(track.at(250).translation.x(), 6.5, 1e-12);
}

}  // namespace
}  // namespace plumbline
