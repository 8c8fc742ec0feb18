// What each detector must say of a room, a tunnel, a plain and a sphere, known in closed form.
#include "estimator/solver/detectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kRowSigma = 0.015;

using Rows = std::vector<MatchRow>;

MatchRow row(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, RandomStream& noise) {
  return {point, normal, 0.02 * noise.gaussian(), 0.02, 1.0};
}

/// 1200 rows on the inside of a box about the sensor, or on some of its walls only.
Rows box(const Eigen::Vector3d& half, const std::function<bool(int axis, double side)>& has_wall) {
  RandomStream draws(3, "box");
  Rows rows;
  while (rows.size() < 1200) {
    const int axis = draws.integer(0, 2);
    const double side = draws.integer(0, 1) == 0 ? -1.0 : 1.0;
    Eigen::Vector3d point;
    for (int i = 0; i < 3; ++i) point[i] = half[i] * draws.uniform(-1.0, 1.0);
    point[axis] = side * half[axis];
    Eigen::Vector3d normal = -side * Eigen::Vector3d::Unit(axis);
    // As fitted normals are: a degree off.
    normal = (normal + 0.017 * Eigen::Vector3d(draws.gaussian(), draws.gaussian(), draws.gaussian())).normalized();
    if (has_wall(axis, side)) rows.push_back(row(point, normal, draws));
  }
  return rows;
}

Rows room() {
  return box({5.0, 4.0, 2.0}, [](int, double) { return true; });
}
Rows tunnel() {
  return box({20.0, 2.0, 2.0}, [](int axis, double) { return axis != 0; });
}
Rows plain() {
  return box({20.0, 20.0, 1.5}, [](int axis, double side) { return axis == 2 && side < 0.0; });
}

Rows sphere() {
  RandomStream draws(4, "sphere");
  Rows rows;
  for (int i = 0; i < 1200; ++i) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(draws.gaussian(), draws.gaussian(), draws.gaussian()).normalized();
    rows.push_back(row(10.0 * direction, -direction, draws));
  }
  return rows;
}

double worst(Detector detector, const Rows& rows) { return detect(detector, rows, kRowSigma).worst(); }

TEST(Detectors, ScoreATunnelAndAPlainBelowARoom) {
  for (const Detector detector : kDetectors) {
    SCOPED_TRACE(to_string(detector));
    EXPECT_LT(worst(detector, tunnel()), worst(detector, room()));
    EXPECT_LT(worst(detector, plain()), worst(detector, room()));
  }
}

TEST(Detectors, FindTheTunnelsAxis) {
  for (const Detector detector : kDetectors) {
    SCOPED_TRACE(to_string(detector));
    const Vector6d found = detect(detector, tunnel(), kRowSigma).directions.front();
    // Within a few degrees: the normals' noise leans the direction.
    EXPECT_GT(std::abs(found[3]), std::cos(5.0 * std::numbers::pi / 180.0)) << found.transpose();
  }
}

TEST(Detectors, FindThatASphereKnowsNoRotationUnlessTheyLookAtTranslationOnly) {
  for (const Detector detector : kDetectors) {
    if (detector == Detector::kCoinLio) continue;
    SCOPED_TRACE(to_string(detector));
    const Detection detection = detect(detector, sphere(), kRowSigma);
    // DCReg's conditions are relative to each block, and all of a sphere's rotations are equally bad.
    if (detector == Detector::kSchur) continue;
    EXPECT_LT(worst(detector, sphere()), worst(detector, room()));
    for (int i = 0; i < 3; ++i) {
      EXPECT_GT(detection.directions[static_cast<std::size_t>(i)].head<3>().norm(), 0.99);
    }
  }
  EXPECT_GT(worst(Detector::kCoinLio, sphere()), 25.0);
}

TEST(Detectors, AreAscendingAndHaveUnitDirections) {
  for (const Detector detector : kDetectors) {
    SCOPED_TRACE(to_string(detector));
    const Detection detection = detect(detector, room(), kRowSigma);
    ASSERT_EQ(detection.scores.size(), detection.directions.size());
    EXPECT_TRUE(std::is_sorted(detection.scores.begin(), detection.scores.end()));
    for (const Vector6d& direction : detection.directions) EXPECT_NEAR(direction.norm(), 1.0, 1e-9);
  }
}

TEST(Detectors, DIsTheLeastWhitenedEigenvaluePlusOne) {
  Rows rows;
  // Two rows along each axis with arms of a metre: eigenvalues are 2 / sigma^2.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      MatchRow one;
      one.normal = Eigen::Vector3d::Unit(axis);
      one.point = side * Eigen::Vector3d::Unit((axis + 1) % 3);
      one.sigma_m = 0.1;
      rows.push_back(one);
    }
  }
  EXPECT_NEAR(worst(Detector::kD, rows), 201.0, 1e-6);
  EXPECT_NEAR(worst(Detector::kIcn, rows), 1.0, 1e-9);
  EXPECT_NEAR(worst(Detector::kNormalised, rows), 1.0 / 6.0, 1e-9);
}

TEST(Detectors, CallNothingDeterminedByTooFewOrBrokenRows) {
  Rows few = room();
  few.resize(5);
  Rows broken = room();
  broken[7].point.x() = std::numeric_limits<double>::quiet_NaN();
  for (const Detector detector : kDetectors) {
    for (const Rows& rows : {Rows{}, few, broken}) EXPECT_EQ(worst(detector, rows), 0.0) << to_string(detector);
  }
}

}  // namespace
}  // namespace plumbline
