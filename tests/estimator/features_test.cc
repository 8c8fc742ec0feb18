#include "estimator/lidar/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/direction_sampling.h"
#include "tests/support/box_world.h"

namespace plumbline {
namespace {

using testing::BoxWorld;
using testing::kRangeSigma;

FeatureCloud features_at(const BoxWorld& world, const Pose& pose, std::uint64_t seed = 1) {
  Calibration calibration;
  calibration.lidar_range_sigma_m = kRangeSigma;
  RandomStream noise(seed, "lidar");
  const LidarScan scan = testing::vlp16_scan(
      world, [&](double) { return pose; }, 0, {}, kRangeSigma, noise);
  PoseTrack rest;
  rest.push(0, {});
  return extract_features(scan, deskew(scan, rest, {}, 0), calibration);
}

Pose standing_at(double x, double y, double z) { return {Eigen::Quaterniond::Identity(), {x, y, z}}; }

/// Clutter on a smooth wall would hold the pose along it.
TEST(Features, SmoothWallsWithNoiseHaveNoEdgesAndNoClutter) {
  BoxWorld two_walls;
  two_walls.boxes.push_back({{-1000.0, -2.0, -1000.0}, {1000.0, 2.0, 1000.0}, true});
  BoxWorld tube;
  tube.tube_radius_m = 2.25;
  std::size_t edges = 0;
  std::size_t clutter = 0;
  const auto count = [&](const FeatureCloud& cloud) {
    edges += cloud.edges.size();
    clutter += cloud.clutter.size();
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    count(features_at(two_walls, standing_at(0.0, 0.0, 0.0), seed));
    count(features_at(two_walls, standing_at(0.0, 1.2, 0.0), seed));
    count(features_at(tube, standing_at(0.0, 0.0, 0.0), seed));
    count(features_at(tube, standing_at(0.0, 0.8, 0.2), seed));
  }
  EXPECT_LE(edges, 2U) << "of 570,000 returns";
  EXPECT_LE(clutter, 20U * 16U) << "the farthest return of a ring has nearer ones on both sides";
}

TEST(Features, FindsTheCornersOfARoomToAFractionOfTheNoise) {
  BoxWorld room;
  room.boxes.push_back({{-3.0, -2.0, -50.0}, {4.0, 2.5, 50.0}, true});  // so tall that only the four corners are edges
  const FeatureCloud cloud = features_at(room, standing_at(0.0, 0.0, 0.0));
  EXPECT_GE(cloud.edges.size(), 60U);  // 4 corners x 16 rings
  double sum = 0.0;
  for (const FeaturePoint& e : cloud.edges) {
    const double dx = std::min(std::abs(e.position.x() + 3.0F), std::abs(e.position.x() - 4.0F));
    const double dy = std::min(std::abs(e.position.y() + 2.0F), std::abs(e.position.y() - 2.5F));
    sum += dx * dx + dy * dy;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(cloud.edges.size())), kRangeSigma);
}

/// The nearest side of something round is elsewhere from everywhere; its axis is not.
TEST(Features, ATrunksEdgeIsItsAxis) {
  BoxWorld world;
  world.boxes.push_back({{-20.0, -20.0, -50.0}, {20.0, 20.0, 50.0}, true});
  const testing::Trunk trunk{{6.0, 1.0}, 0.2};
  world.trunks.push_back(trunk);
  for (const Pose& pose : {standing_at(0.0, 0.0, 0.0), standing_at(4.5, -2.0, 0.0)}) {
    int on_axis = 0;
    for (const FeaturePoint& e : features_at(world, pose).edges) {
      const Eigen::Vector2d off = (pose * e.position.cast<double>()).head<2>() - trunk.axis;
      if (off.norm() > 0.5) continue;
      // Its borders before the wall are edges, too.
      const Eigen::Vector2d beam = (trunk.axis - pose.translation.head<2>()).normalized();
      if (std::abs(beam.x() * off.y() - beam.y() * off.x()) > 0.7 * trunk.radius_m) continue;
      EXPECT_LT(off.norm(), 0.25 * trunk.radius_m);
      ++on_axis;
    }
    EXPECT_GE(on_axis, 8);  // of 16 rings
  }
}

/// Far off a trunk shows a few returns, too few for a shape. The middle between its borders is its axis all the same,
/// before a wall as before the sky. (The only things upright that an orchard or a highway offers.)
TEST(Features, AFarTrunksEdgeIsItsAxis) {
  BoxWorld walled;
  walled.boxes.push_back({{-40.0, -40.0, -50.0}, {40.0, 40.0, 50.0}, true});
  BoxWorld before_the_sky;
  before_the_sky.boxes.push_back({{-20.0, -50.0, -50.0}, {40.0, -40.0, 50.0}, false});
  before_the_sky.boxes.push_back({{-20.0, 40.0, -50.0}, {40.0, 50.0, 50.0}, false});
  for (BoxWorld world : {walled, before_the_sky}) {
    const testing::Trunk trunk{{-14.0, 2.0}, 0.12};
    world.trunks.push_back(trunk);
    for (const Pose& pose : {standing_at(0.0, 0.0, 0.0), standing_at(-10.0, -12.0, 0.0)}) {
      int on_axis = 0;
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (const FeaturePoint& e : features_at(world, pose).edges) {
        const Eigen::Vector2d off = (pose * e.position.cast<double>()).head<2>() - trunk.axis;
        if (off.norm() > 1.0) continue;
        // Either border lies anywhere between two beams 3.5 mrad apart.
        EXPECT_LT(off.norm(), 0.05 + 3.0 * kRangeSigma);
        sum += off;
        ++on_axis;
      }
      ASSERT_GE(on_axis, 12);  // of 16 rings
      EXPECT_LT((sum / on_axis).norm(), 0.025) << "no side of it is preferred";
    }
  }
}

/// A hole in a wall, or returns that it did not give, leave pieces as narrow as a trunk. They stand where the holes are
/// seen from.
TEST(Features, APieceOfAWallIsNoPole) {
  BoxWorld world;
  world.boxes.push_back({{-8.0, -8.0, -50.0}, {8.0, 8.0, 50.0}, true});
  Calibration calibration;
  calibration.lidar_range_sigma_m = kRangeSigma;
  RandomStream noise(1, "lidar");
  LidarScan scan = testing::vlp16_scan(
      world, [](double) { return Pose{}; }, 0, {}, kRangeSigma, noise);
  // Of every 1.5 degrees of the sweep the first half is kept.
  std::erase_if(scan.points, [](const LidarPoint& p) {
    const double turns = std::atan2(p.position.y(), p.position.x()) * 120.0 / M_PI;
    return turns - std::floor(turns) > 0.5;
  });
  PoseTrack rest;
  rest.push(0, {});
  EXPECT_TRUE(extract_features(scan, deskew(scan, rest, {}, 0), calibration).edges.empty());
}

TEST(Features, OfAnOcclusionOnlyTheNearSideIsAnEdge) {
  BoxWorld world;
  world.boxes.push_back({{-8.0, -8.0, -50.0}, {8.0, 8.0, 50.0}, true});
  world.boxes.push_back(
      {{4.0, -0.5, -50.0}, {4.3, 0.5, 50.0}, false});  // a pillar whose shadow falls on the wall x = 8
  const FeatureCloud cloud = features_at(world, standing_at(0.0, 0.0, 0.0));
  int near_side = 0;
  for (const FeaturePoint& e : cloud.edges) {
    const bool ahead = e.position.x() > 3.0F && std::abs(e.position.y()) < 2.0F;
    if (!ahead) continue;
    EXPECT_LT(e.position.x(), 4.5F) << "an edge at the border of the pillar's shadow";
    ++near_side;
  }
  EXPECT_GE(near_side, 28);  // both borders in (nearly) every ring
}

/// A lidar in a fast car stands metres from where it will stand at the sweep's end. What a beam passed, and which side
/// of a surface it met, follows from where it was fired: seen from the end of the sweep, borders lay beside the pillars
/// or were taken for creases across the gap, and faces that the car had passed turned their backs.
TEST(Features, WhatIsPassedAtSpeedIsSeenFromWhereTheBeamsWereFired) {
  const testing::Motion motion = [](double t) { return Pose{Eigen::Quaterniond::Identity(), {30.0 * t, 0.0, 0.0}}; };
  BoxWorld world;
  world.boxes.push_back({{-40.0, -40.0, -50.0}, {40.0, 40.0, 50.0}, true});
  std::vector<testing::Box> pillars;
  for (const double x : {-4.0, -1.0, 2.0, 5.0, 8.0}) {
    for (const double y : {-5.0, 4.0}) pillars.push_back({{x, y, -50.0}, {x + 1.0, y + 1.0, 50.0}, false});
  }
  world.boxes.insert(world.boxes.end(), pillars.begin(), pillars.end());
  RandomStream noise(1, "lidar");
  const LidarScan scan = testing::vlp16_scan(world, motion, 0, {}, kRangeSigma, noise);
  PoseTrack track;
  for (std::int64_t ns = 0; ns <= scan.end_ns; ns += 5'000'000) track.push(ns, motion(1e-9 * static_cast<double>(ns)));
  Calibration calibration;
  calibration.lidar_range_sigma_m = kRangeSigma;
  const FeatureCloud cloud = extract_features(scan, deskew(scan, track, {}, scan.end_ns), calibration);

  const Pose world_from_body = track.at(scan.end_ns);
  const auto pillar_at = [&](const Eigen::Vector3d& point) {
    return std::find_if(pillars.begin(), pillars.end(), [&](const testing::Box& box) {
      const Eigen::Vector2d beyond = (box.low - point).cwiseMax(point - box.high).head<2>();
      return beyond.maxCoeff() < 0.3;
    });
  };
  int borders = 0;
  for (const FeaturePoint& e : cloud.edges) {
    const Eigen::Vector3d point = world_from_body * e.position.cast<double>();
    const auto box = pillar_at(point);
    if (box == pillars.end()) continue;
    const Eigen::Vector2d off = (point - box->low).cwiseAbs().cwiseMin((point - box->high).cwiseAbs()).head<2>();
    // Between two beams 3.5 mrad apart, at up to 10 m, and met aslant; and the noise of one return.
    EXPECT_LT(off.norm(), 0.06 + 4.0 * kRangeSigma) << point.transpose();
    ++borders;
  }
  EXPECT_GE(borders, 100);
  int planes = 0;
  for (const FeaturePoint& p : cloud.planes) {
    const Eigen::Vector3d point = world_from_body * p.position.cast<double>();
    const auto box = pillar_at(point);
    if (box == pillars.end()) continue;
    const Eigen::Vector3d from_centre = point - 0.5 * (box->low + box->high);
    EXPECT_GT(p.normal.head<2>().cast<double>().dot(from_centre.head<2>()), 0.0) << point.transpose();
    ++planes;
  }
  EXPECT_GE(planes, 100);
}

TEST(Features, PlanesLieOnTheSurfacesAndFaceTheSensor) {
  const BoxWorld room = testing::furnished_room();
  const Pose pose = standing_at(0.5, -0.5, 0.0);
  const FeatureCloud cloud = features_at(room, pose);
  EXPECT_GT(cloud.planes.size(), 1200U);
  int tilted = 0;
  int off = 0;
  for (const FeaturePoint& p : cloud.planes) {
    off += room.distance(pose * p.position.cast<double>()) > 4.0 * kRangeSigma ? 1 : 0;
    EXPECT_LT(p.normal.dot(p.position), 0.0F);
    EXPECT_NEAR(p.normal.norm(), 1.0F, 1e-4F);
    tilted += p.normal.cwiseAbs().maxCoeff() < 0.9F ? 1 : 0;  // all true normals are axes
  }
  EXPECT_LT(off, static_cast<int>(cloud.planes.size()) / 100) << "beside creases, where a mean rounds the corner off";
  EXPECT_LT(tilted, static_cast<int>(cloud.planes.size()) / 20);
}

TEST(Features, GrazedSurfacesGiveNoPlanes) {
  BoxWorld world;
  world.boxes.push_back({{-200.0, -200.0, -1.2}, {200.0, 200.0, 60.0}, true});
  for (const FeaturePoint& p : features_at(world, standing_at(0.0, 0.0, 0.0)).planes) {
    EXPECT_GT(std::abs(p.normal.dot(p.position.normalized())), 0.15F);  // 10 degrees, less the noise of normals
  }
}

TEST(Features, UnusableReturnsAreLeftOut) {
  LidarScan scan;
  scan.end_ns = 100'000'000;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(nan, 0, 0), Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1e6, 0, 0)}) {
    for (const std::uint16_t ring : {0, 15, 999}) {
      LidarPoint point;
      point.position = p;
      point.ring = ring;
      scan.points.push_back(point);
    }
  }
  const DeskewedScan deskewed{std::vector<Eigen::Vector3f>(scan.points.size(), Eigen::Vector3f::Ones()),
                              std::vector<Eigen::Vector3f>(2, Eigen::Vector3f::Zero())};
  const FeatureCloud cloud = extract_features(scan, deskewed, {});
  EXPECT_TRUE(cloud.edges.empty());
  EXPECT_TRUE(cloud.planes.empty());
}

TEST(DirectionSampling, KeepsTheFewThatFaceAlongATunnel) {
  std::vector<FeaturePoint> planes(5000);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i].normal = Eigen::Vector3f::Unit(i % 2 == 0 ? 1 : 2);
    if (i % 100 == 0) planes[i].normal = -Eigen::Vector3f::UnitX();
  }
  const auto picked = sample_by_direction(planes, 600);
  EXPECT_LE(picked.size(), 600U);
  EXPECT_GE(picked.size(), 595U);
  const auto along = std::count_if(picked.begin(), picked.end(), [&](auto i) { return planes[i].normal.x() < -0.5F; });
  EXPECT_EQ(along, 50);
  EXPECT_TRUE(std::is_sorted(picked.begin(), picked.end()));
  EXPECT_EQ(sample_by_direction(planes, 10000).size(), planes.size());
}

}  // namespace
}  // namespace plumbline
