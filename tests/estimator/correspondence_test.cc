#include "estimator/lidar/correspondence.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/geometry/so3.h"
#include "sim/random_stream.h"
#include "tests/support/jacobian_check.h"

namespace plumbline {
namespace {

std::vector<Pose> poses() {
  return {{},
          {exp_so3({1e-5, 0.0, -1e-5}), {0.1, 0.0, 0.0}},
          {exp_so3({0.4, -1.1, 2.0}), {12.0, -7.0, 3.0}},
          {exp_so3({-2.0, 1.5, 0.3}), {900.0, 40.0, -5.0}}};
}

const Eigen::Vector3d kPoint(3.0, -5.0, 0.7);

TEST(Correspondence, PlaneRowJacobianMatchesCentralDifferences) {
  const MapPlane plane = {Eigen::Vector3d(0.3, -0.5, 0.8).normalized(), 2.0};
  const auto rows_at = [&](const Pose& pose) {
    ResidualRows rows;
    add_plane_row(kPoint, plane, pose, 0.02, rows);
    return rows;
  };
  for (const Pose& pose : poses()) {
    testing::expect_jacobian_near([&](const Pose& p) { return rows_at(p).residual(0); }, pose,
                                  rows_at(pose).jacobian(0));
  }
}

TEST(Correspondence, LineRowJacobiansMatchCentralDifferencesAlsoOnTheLine) {
  MapLine line = {{1.0, 2.0, 3.0}, Eigen::Vector3d(1.0, 1.0, 0.0).normalized(), Eigen::Vector3d::UnitZ()};
  for (const Pose& pose : poses()) {
    for (const bool on_line : {false, true}) {
      if (on_line) line.point = pose * kPoint;  // where the norm (5.14) has no derivative
      const auto rows_at = [&](const Pose& p) {
        ResidualRows rows;
        add_line_rows(kPoint, line, p, 0.02, rows);
        return rows;
      };
      ASSERT_EQ(rows_at(pose).feature_count(), 1);
      for (const int r : {0, 1}) {
        testing::expect_jacobian_near([&](const Pose& p) { return rows_at(p).residual(r); }, pose,
                                      rows_at(pose).jacobian(r));
      }
    }
  }
}

const Eigen::Vector3d kBeside = Eigen::Vector3d::Zero();

NearestSamples offered(const std::vector<MapSample>& samples) {
  NearestSamples nearest(NearestSamples::kCapacity, 100.0, Eigen::Vector3f::Zero());
  for (const MapSample& s : samples) nearest.offer(s.position.squaredNorm(), s);
  return nearest;
}

std::vector<MapSample> grid(int across, double spacing, double sigma) {
  RandomStream random(1, "grid");
  std::vector<MapSample> samples;
  for (int k = 0; k < 10; ++k) {
    MapSample s;
    s.position = {spacing * (k / across), spacing * (k % across), sigma * random.gaussian()};
    samples.push_back(s);
  }
  return samples;
}

TEST(Correspondence, FindsAPlaneThroughTwoRings) {
  const auto samples = grid(2, 0.4, 0.01);
  const auto plane = fit_plane(offered(samples), {}, kBeside);
  ASSERT_TRUE(plane.has_value());
  EXPECT_GT(std::abs(plane->normal.z()), std::cos(0.05));
}

/// At rest a ring leaves a strip on the road; as the car pitches in moving off, the ring falls a metre ahead of it.
/// What the strip's twist would say of the road there turned the pose by 1.5 mrad within half a second, in which it was
/// sure of 0.2.
TEST(Correspondence, APlaneTellsNothingFarBesideTheStripThatItIsThrough) {
  const NearestSamples strip = offered(grid(2, 0.4, 0.003));
  EXPECT_TRUE(fit_plane(strip, {}, {0.8, 0.2, 0.0}).has_value());
  EXPECT_TRUE(fit_plane(strip, {}, {2.0, 0.2, 0.0}).has_value());  // along it is another matter
  EXPECT_FALSE(fit_plane(strip, {}, {0.8, 1.2, 0.0}).has_value());
}

TEST(Correspondence, NeighboursOfASingleRingAreNoPlane) {
  const auto samples = grid(1, 0.2, 0.01);
  EXPECT_FALSE(fit_plane(offered(samples), {}, kBeside).has_value());
  const auto line = fit_line(offered(samples), {});
  ASSERT_TRUE(line.has_value());
  EXPECT_LT(std::abs(line->across_1.x()), 0.05);
  EXPECT_LT(std::abs(line->across_2.x()), 0.05);
}

/// One ring on a floor ten metres away: range noise spreads its points along their beams, and the best plane through
/// them holds the beams, seven degrees off the floor. The points' own normals, from ring to ring, know better.
TEST(Correspondence, TheNoiseOfASingleRingIsNoPlane) {
  const Eigen::Vector3d beam = Eigen::Vector3d(10.0, 0.0, -1.2).normalized();
  RandomStream random(1, "ring");
  std::vector<MapSample> samples;
  for (int k = 0; k < 10; ++k) {
    MapSample s;
    s.position = Eigen::Vector3d(0.0, 0.2 * k, 0.0) + 0.2 * random.gaussian() * beam;
    s.normal = Eigen::Vector3f::UnitZ();
    samples.push_back(s);
  }
  FitLimits limits;
  limits.largest_disagreement = 0.05;
  EXPECT_FALSE(fit_plane(offered(samples), limits, kBeside).has_value());
  for (MapSample& s : samples) s.normal = beam.cross(Eigen::Vector3d::UnitY()).cast<float>();
  EXPECT_TRUE(fit_plane(offered(samples), limits, kBeside).has_value());  // it is the normals that told
}

TEST(Correspondence, ABlobIsNeitherPlaneNorLine) {
  const auto samples = grid(3, 0.3, 0.3);
  EXPECT_FALSE(fit_plane(offered(samples), {}, kBeside).has_value());
  EXPECT_FALSE(fit_line(offered(samples), {}).has_value());
}

TEST(Correspondence, OfTwoParallelEdgesTheNearerOnesLineIsFound) {
  std::vector<MapSample> samples;
  for (int k = 0; k < 8; ++k) {
    MapSample near;
    near.position = {0.0, 0.0, 0.1 + 0.1 * k};
    MapSample far;
    far.position = {0.12, 0.0, 0.1 + 0.1 * k};
    samples.push_back(near);
    samples.push_back(far);
  }
  const auto line = fit_line(offered(samples), {.largest_residual_m = 0.03});
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->point.x(), 0.0, 1e-9);
}

/// On a wall the nearest map point is the one that the same beam left: to be drawn to it is to stay where one is.
TEST(Correspondence, AClutterPointHasAPartnerInsideFoliageButNoneOnAWall) {
  EXPECT_FALSE(line_through_clutter(offered(grid(4, 0.15, 0.01)), Eigen::Vector3d::UnitZ()));
  RandomStream random(2, "foliage");
  std::vector<MapSample> leaves;
  for (int i = 0; i < 16; ++i) {
    leaves.push_back({Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()) * 0.2, {}});
  }
  const auto nearer = [](const MapSample& a, const MapSample& b) {
    return a.position.squaredNorm() < b.position.squaredNorm();
  };
  const MapSample nearest = *std::min_element(leaves.begin(), leaves.end(), nearer);
  const Eigen::Vector3d unseen = Eigen::Vector3d(0.1, -0.3, 1.0).normalized();
  const auto line = line_through_clutter(offered(leaves), unseen);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->point, nearest.position);
  Eigen::Matrix3d axes;
  axes << line->across_1, line->across_2, unseen;
  EXPECT_TRUE(axes.isUnitary(1e-12)) << "nothing is asked along the unseen direction";
}

}  // namespace
}  // namespace plumbline
