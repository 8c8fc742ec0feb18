// The exact information against closed forms: a plane, a box room, a tube, a sphere; and a camera by differences.
#include "sensors/information.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "scenarios/catalogue.h"
#include "sim/random_stream.h"
#include "tools/verify/lidar_stand.h"

namespace plumbline {
namespace {

using Class = DegeneracyLabel::Class;

constexpr double kSigma = 0.02;

PoseTrack track(const Pose& begin, const Pose& end) {
  PoseTrack poses;
  poses.push(0, begin);
  poses.push(100'000'000, end);
  return poses;
}

std::vector<SurfacePoint> cast(const LidarStand& stand, const Pose& world_from_body = {}) {
  const TrueReturns lidar(catalogue_lidar("vlp16"), {});
  return lidar.cast({stand.world, stand.rays}, track(world_from_body, world_from_body), 0, 0).points;
}

/// A dense grid of points on the inside of a shape that rays from the middle reach.
std::vector<SurfacePoint> around(int count, const std::function<SurfacePoint(const Eigen::Vector3d&)>& hit) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    // Fibonacci's lattice: even over the sphere of directions.
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    points.push_back(hit({std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z}));
  }
  return points;
}

TEST(LidarInformation, OfAPlaneIsItsClosedForm) {
  // Points (x, y, -h) with normal z: v = (y, -x, 0, 0, 0, 1).
  std::vector<SurfacePoint> points;
  for (const double x : {-3.0, 3.0}) {
    for (const double y : {-2.0, 2.0}) points.push_back({{x, y, -1.5}, Eigen::Vector3d::UnitZ()});
  }
  Matrix6d expected = Matrix6d::Zero();
  expected.diagonal() << 4 * 4.0, 4 * 9.0, 0, 0, 0, 4;
  EXPECT_LT((lidar_information(points, kSigma) * kSigma * kSigma - expected).norm(), 1e-12);
  const DegeneracyLabel found = label(lidar_information(points, kSigma), kLidarLimits);
  EXPECT_EQ(found.degenerate(), 3);
  EXPECT_EQ(found.worst(), Class::kDegenerate);
  EXPECT_DOUBLE_EQ(found.excess[2], 1e6);
}

TEST(LidarInformation, OfASphereKnowsNoRotation) {
  static constexpr double kRadius = 7.0;
  static constexpr int kCount = 20'000;
  const auto points = around(kCount, [](const Eigen::Vector3d& direction) {
    return SurfacePoint{kRadius * direction, -direction};
  });
  Matrix6d expected = Matrix6d::Zero();
  expected.diagonal().tail<3>().setConstant(kCount / 3.0 / (kSigma * kSigma));
  const Matrix6d found = lidar_information(points, kSigma);
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());  // of the lattice's evenness
  const DegeneracyLabel labels = label(found, kLidarLimits);
  EXPECT_EQ(labels.degenerate(), 3);
  EXPECT_LT(labels.directions.leftCols<3>().bottomRows<3>().norm(), 1e-9);  // rotations, purely
}

TEST(LidarInformation, OfATubeKnowsNeitherTheWayAlongItNorTheRoll) {
  const auto points = around(20'000, [](const Eigen::Vector3d& direction) {
    const double across = std::hypot(direction.y(), direction.z());
    return SurfacePoint{direction * 2.0 / across, -Eigen::Vector3d(0.0, direction.y(), direction.z()) / across};
  });
  const DegeneracyLabel labels = label(lidar_information(points, kSigma), kLidarLimits);
  EXPECT_EQ(labels.degenerate(), 2);
  // Both lie in the plane of x's rotation and translation.
  Matrix6d others = labels.directions;
  others.row(0).setZero();
  others.row(3).setZero();
  EXPECT_LT(others.leftCols<2>().norm(), 1e-9);
}

TEST(LidarInformation, OfARoomIsWellDeterminedWithTheBoundThatItsWallsGive) {
  // Six points, one in the middle of each wall, twice: translation information is 2 * 2 / sigma^2 along each axis.
  const double half = 3.0;
  std::vector<SurfacePoint> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d n = Eigen::Vector3d::Zero();
      n[axis] = -side;
      for (const double off : {-1.0, 1.0}) {
        Eigen::Vector3d p = -half * n;
        p[(axis + 1) % 3] = off;
        points.push_back({p, n});
      }
    }
  }
  const Matrix6d bound = cramer_rao_bound(lidar_information(points, kSigma), kLidarLimits);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::sqrt(bound(3 + i, 3 + i)), kSigma / 2.0, 1e-12);  // four points see each axis
    EXPECT_NEAR(std::sqrt(bound(i, i)), kSigma / 2.0, 1e-12);          // with levers of a metre
  }
}

TEST(LidarInformation, MovesWithTheSensorsFrameAsTheAdjointSays) {
  RandomStream draws(1, "points");
  const auto random = [&] { return Eigen::Vector3d(draws.uniform(-1, 1), draws.uniform(-1, 1), draws.uniform(-1, 1)); };
  const Pose other_from_sensor{rotation_from_rpy({0.3, -0.2, 1.0}), {0.5, -1.0, 2.0}};
  std::vector<SurfacePoint> points;
  std::vector<SurfacePoint> moved;
  for (int i = 0; i < 30; ++i) {
    points.push_back({5.0 * random(), random().normalized()});
    moved.push_back({other_from_sensor * points.back().position, other_from_sensor.rotation * points.back().normal});
  }
  const Matrix6d ad = adjoint(other_from_sensor);
  const Matrix6d expected = ad.transpose() * lidar_information(moved, kSigma) * ad;
  const Matrix6d found = lidar_information(points, kSigma);
  EXPECT_LT((found - expected).norm(), 1e-12 * found.norm());
}

TEST(ImageInformation, AgreesWithDifferencesOfTheProjection) {
  CameraIntrinsics camera;
  camera.fx = 300.0;
  camera.fy = 320.0;
  const std::vector<Eigen::Vector3d> points = {{0.5, -0.2, 3.0}, {-1.0, 0.4, 5.0}, {0.1, 1.0, 2.0}};
  Matrix6d expected = Matrix6d::Zero();
  for (const Eigen::Vector3d& point : points) {
    Eigen::Matrix<double, 2, 6> rows;
    const auto project = [&](const Vector6d& perturbation) {
      const Eigen::Vector3d p = Pose{}.retract(perturbation).inverse() * point;
      return Eigen::Vector2d(camera.fx * p.x() / p.z(), camera.fy * p.y() / p.z());
    };
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = 1e-6 * Vector6d::Unit(i);
      rows.col(i) = (project(step) - project(-step)) / 2e-6;
    }
    expected += rows.transpose() * rows / 0.25;
  }
  std::vector<Eigen::Vector3d> with_one_behind = points;
  with_one_behind.push_back({0.0, 0.0, -1.0});
  const Matrix6d found = image_information(with_one_behind, camera, 0.5);
  EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());  // of the differences
}

TEST(DegeneracyLabel, HasAGreyZoneAboutTheLimit) {
  const auto of_translation_sigma = [](double sigma_m) {
    Matrix6d information = 1e9 * Matrix6d::Identity();
    information(4, 4) = 1.0 / (sigma_m * sigma_m);
    return label(information, kLidarLimits);
  };
  EXPECT_EQ(of_translation_sigma(0.05 * 1.51).worst(), Class::kDegenerate);
  EXPECT_EQ(of_translation_sigma(0.05 * 1.49).worst(), Class::kGrey);
  EXPECT_EQ(of_translation_sigma(0.05 / 1.49).worst(), Class::kGrey);
  EXPECT_EQ(of_translation_sigma(0.05 / 1.51).worst(), Class::kWell);
  EXPECT_NEAR(of_translation_sigma(0.1).excess[0], 2.0, 1e-9);
  EXPECT_NEAR(of_translation_sigma(0.1).directions(4, 0) * of_translation_sigma(0.1).directions(4, 0), 0.05 * 0.05,
              1e-12);
}

TEST(DegeneracyLabel, OfAPureRotationIsJudgedInDegrees) {
  Matrix6d information = 1e9 * Matrix6d::Identity();
  const double sigma_rad = 1.0 * std::numbers::pi / 180.0;
  information(2, 2) = 1.0 / (sigma_rad * sigma_rad);
  EXPECT_NEAR(label(information, kLidarLimits).excess[0], 2.0, 1e-9);
  EXPECT_NEAR(label(information, kImageLimits).excess[0], 1.0, 1e-9);
}

TEST(TrueReturns, LieOnTheSurfacesWithTheirNormalsTowardsTheSensor) {
  const LidarStand room(
      R"(<geom type="box" size="0.1 5 3" pos="6 0 0"/><geom type="plane" size="0 0 1" pos="0 0 -1.5"/>)");
  const auto points = cast(room);
  ASSERT_GT(points.size(), 5'000u);
  int on_wall = 0;
  for (const SurfacePoint& point : points) {
    const bool is_wall = std::abs(point.position.x() - 5.9) < 1e-4;
    const Eigen::Vector3d normal = is_wall ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(0, 0, 1);
    on_wall += is_wall ? 1 : 0;
    ASSERT_TRUE(is_wall || std::abs(point.position.z() + 1.5) < 1e-4) << point.position.transpose();
    ASSERT_LT((point.normal - normal).norm(), 1e-5);
  }
  EXPECT_GT(on_wall, 1'000);
}

TEST(TrueReturns, AreFreeOfTheMotionDuringTheScan) {
  const LidarStand wall(R"(<geom type="box" size="0.1 50 30" pos="6 0 0"/>)");
  const Pose end{rotation_from_rpy({0.0, 0.0, 0.2}), {0.3, 0.0, 0.0}};
  const TrueReturns lidar(catalogue_lidar("vlp16"), {});
  const auto scan = lidar.cast({wall.world, wall.rays}, track({}, end), 0, 0);
  ASSERT_GT(scan.points.size(), 1'000u);
  for (const SurfacePoint& point : scan.points) ASSERT_NEAR((end * point.position).x(), 5.9, 1e-4);
}

TEST(TrueReturns, LeaveOutTheVehicleWhatMovesAndWhatIsTooFar) {
  const LidarStand wall(R"(<geom type="box" size="0.1 50 30" pos="60 0 0"/>)", 0.05F);
  EXPECT_TRUE(cast(wall).empty());  // dark: found to 35 m only
  const LidarStand near(R"(<geom type="box" size="0.1 50 30" pos="10 0 0"/>)");
  LidarStand bonnet(R"(<geom type="box" size="0.1 0.5 0.5" pos="2 0 0"/>)");
  const OwnBody own{std::move(bonnet.world), std::move(bonnet.rays), {}};
  const TrueReturns lidar(catalogue_lidar("vlp16"), {});
  const auto scan = lidar.cast({near.world, near.rays, &own}, track({}, {}), 0, 0);
  EXPECT_GT(scan.on_own_body, 1'000u);
  EXPECT_GT(scan.points.size(), 1'000u);
  for (const SurfacePoint& point : scan.points) ASSERT_GT(point.position.x(), 9.0);
}

}  // namespace
}  // namespace plumbline
