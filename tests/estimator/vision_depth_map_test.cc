#include "estimator/vision/depth_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const CameraIntrinsics kDepthCamera{640, 360, 474.0, 474.0, 319.5, 179.5};

/// Camera at the world's origin, z forward: the world here is the camera's own frame.
std::vector<Vector3f> rings_on_plane(const Vector3d& point, const Vector3d& normal, double left_deg, double right_deg,
                                     double ring_spacing_deg = 2.0) {
  std::vector<Vector3f> points;
  constexpr double kDegree = M_PI / 180.0;
  for (double elevation = -20.0; elevation <= 20.0; elevation += ring_spacing_deg) {
    for (double azimuth = left_deg; azimuth <= right_deg; azimuth += 0.2) {
      const Vector3d beam(std::sin(azimuth * kDegree) * std::cos(elevation * kDegree), std::sin(elevation * kDegree),
                          std::cos(azimuth * kDegree) * std::cos(elevation * kDegree));
      points.push_back((beam * (normal.dot(point) / normal.dot(beam))).cast<float>());
    }
  }
  return points;
}

DepthMap map_of(const std::vector<Vector3f>& points) {
  DepthMap map(kDepthCamera, DepthMapConfig{});
  map.add(0, DepthSource::kLidar, points, std::nullopt);
  map.look_from(Pose{}, 0);
  return map;
}

TEST(DepthMap, FindsAPlanesDepthBetweenTheRings) {
  const Vector3d point(0, 0, 5);
  const Vector3d normal = Vector3d(0.4, -0.2, -1.0).normalized();
  const DepthMap map = map_of(rings_on_plane(point, normal, -38, 38));
  int found = 0;
  for (double x = -0.6; x < 0.6; x += 0.05) {
    for (double y = -0.3; y < 0.3; y += 0.05) {
      const Vector3d ray(x, y, 1);
      const auto depth = map.depth_along(ray);
      if (!depth) continue;
      ++found;
      EXPECT_NEAR(1.0 / depth->depth.mean, normal.dot(point) / normal.dot(ray),
                  1e-3);  // float points at 5 m: 1e-6 each
      EXPECT_GT(depth->depth.sigma, 0.0);
      EXPECT_LT(depth->depth.sigma / depth->depth.mean, 0.02);
    }
  }
  EXPECT_GT(found, 0.95 * 24 * 12);
}

TEST(DepthMap, ReadsTheViewFromWhereTheCameraIs) {
  const std::vector<Vector3f> points = rings_on_plane({0, 0, 5}, {0, 0, -1}, -38, 38);
  DepthMap map(kDepthCamera, DepthMapConfig{});
  map.add(0, DepthSource::kLidar, points, std::nullopt);
  map.look_from({Eigen::Quaterniond::Identity(), Vector3d(0.1, 0.0, 0.5)}, 0);
  const auto depth = map.depth_along({0.05, 0.02, 1});
  ASSERT_TRUE(depth.has_value());
  EXPECT_NEAR(1.0 / depth->depth.mean, 4.5, 1e-3);
}

TEST(DepthMap, RefusesRaysBetweenForegroundAndBackground) {
  std::vector<Vector3f> points = rings_on_plane({0, 0, 3}, {0, 0, -1}, -38, -1);
  const std::vector<Vector3f> background = rings_on_plane({0, 0, 8}, {0, 0, -1}, 0, 38);
  points.insert(points.end(), background.begin(), background.end());
  const DepthMap map = map_of(points);
  EXPECT_FALSE(map.depth_along({std::tan(-0.3 * M_PI / 180.0), 0.01, 1}).has_value());
  const auto left = map.depth_along({-0.2, 0.01, 1});
  const auto right = map.depth_along({0.2, 0.01, 1});
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(1.0 / left->depth.mean, 3.0, 1e-3);
  EXPECT_NEAR(1.0 / right->depth.mean, 8.0, 1e-3);
}

TEST(DepthMap, PrefersTheSurfaceInFrontWhereBothSurroundTheRay) {
  // Rings on the wall fall between the rings on the board: the wall was seen there before the board hid it.
  std::vector<Vector3f> points = rings_on_plane({0, 0, 3}, {0, 0, -1}, -10, 10);
  for (Vector3f& p : points) p.y() += 3.0F * std::tan(1.0F * static_cast<float>(M_PI) / 180.0F);
  const std::vector<Vector3f> wall = rings_on_plane({0, 0, 8}, {0, 0, -1}, -38, 38);
  points.insert(points.end(), wall.begin(), wall.end());
  const DepthMap map = map_of(points);
  const auto depth = map.depth_along({0.01, 0.005, 1});
  ASSERT_TRUE(depth.has_value());
  EXPECT_NEAR(1.0 / depth->depth.mean, 3.0, 1e-3);
}

TEST(DepthMap, RefusesGrazingPlanesAndPlacesWithoutPoints) {
  // A floor 0.05 m below the eye, seen at its far end: 1 degree of grazing.
  const DepthMap floor = map_of(rings_on_plane({0, 0.05, 0}, {0, -1, 0}, -38, 38, 0.5));
  EXPECT_FALSE(floor.depth_along({0.0, 0.02, 1}).has_value());
  const DepthMap left_only = map_of(rings_on_plane({0, 0, 5}, {0, 0, -1}, -38, -5));
  EXPECT_FALSE(left_only.depth_along({0.2, 0.0, 1}).has_value());
}

TEST(DepthMap, IgnoresPointsBehindOldPointsAndNonsense) {
  DepthMap map(kDepthCamera, DepthMapConfig{});
  EXPECT_FALSE(map.depth_along({0, 0, 1}).has_value());
  map.look_from(Pose{}, 0);
  EXPECT_FALSE(map.depth_along({0, 0, 1}).has_value());

  std::vector<Vector3f> behind = rings_on_plane({0, 0, 5}, {0, 0, -1}, -38, 38);
  for (Vector3f& p : behind) p = -p;
  behind.emplace_back(0.0F, 0.0F, std::numeric_limits<float>::quiet_NaN());
  behind.emplace_back(0.0F, 0.0F, 0.0F);
  map.add(0, DepthSource::kLidar, behind, std::nullopt);
  map.look_from(Pose{}, 0);
  EXPECT_EQ(map.points_in_view(), 0U);

  map.add(0, DepthSource::kLidar, rings_on_plane({0, 0, 5}, {0, 0, -1}, -38, 38), std::nullopt);
  map.look_from(Pose{}, 10'000'000'000);
  EXPECT_EQ(map.points_in_view(), 0U);
}

TEST(DepthMap, CroppingAtInsertionCostsNothingInsideTheView) {
  const std::vector<Vector3f> points = rings_on_plane({0, 0, 5}, {0, 0, -1}, -60, 60);
  DepthMap cropped(kDepthCamera, DepthMapConfig{});
  cropped.add(0, DepthSource::kLidar, points, Pose{});
  const Pose turned{exp_so3({0.0, 0.3, 0.0}), Vector3d(0.1, 0, 0)};
  cropped.look_from(turned, 0);
  DepthMap whole(kDepthCamera, DepthMapConfig{});
  whole.add(0, DepthSource::kLidar, points, std::nullopt);
  whole.look_from(turned, 0);
  EXPECT_EQ(cropped.points_in_view(), whole.points_in_view());
}

}  // namespace
}  // namespace plumbline
