#include "estimator/localization/map_merger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimator/localization/map_support.h"
#include "sim/random_stream.h"
#include "tests/estimator/localization_world.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

/// The same map seen from another frame.
PriorMap moved(PriorMap map, const Pose& target_from_source) {
  move(map.surfaces, target_from_source, 0.0F);
  return map;
}

Pose apart(double metres, double yaw) {
  return {rotation_from_rpy({0.0, 0.0, yaw}), {metres, -0.5 * metres, 0.2 * metres}};
}

TEST(MapMerger, FindsHowOneMapLiesOnAnother) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const PriorMap a = testing::mapped_along_x(hall, 12.0);
  const Pose a_from_b = apart(0.4, 0.03);
  const PriorMap b =
      moved(testing::mapped_along_x(hall, 20.0, /*with_normals=*/true, /*from_m=*/8.0), a_from_b.inverse());
  const MapAlignment alignment = align_maps(a, b, Pose{});
  ASSERT_EQ(alignment.refusal, "");
  // At 10 m from the origin the two maps' noise, millimetres, and cells of a decimetre are all that is left.
  const Eigen::Vector3d there(10.0, 0.0, 0.0);
  EXPECT_LT((alignment.a_from_b * (a_from_b.inverse() * there) - there).norm(), 0.01);
  EXPECT_LT(alignment.residual_median_m, 0.02);
  EXPECT_GT(alignment.overlap, 0.5);
  EXPECT_GT(alignment.support, 0.5);
}

TEST(MapMerger, RefusesAWrongOverlap) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const PriorMap a = testing::mapped_along_x(hall, 10.0);
  EXPECT_NE(align_maps(a, testing::mapped_along_x(testing::furnished_room(), 3.0), Pose{}).refusal, "");
  EXPECT_NE(align_maps(a, moved(a, apart(6.0, 1.0)), Pose{}).refusal, "");
  const Pose far{Eigen::Quaterniond::Identity(), {500.0, 0.0, 0.0}};
  EXPECT_THAT(align_maps(a, a, far).refusal, HasSubstr("do not overlap"));
}

TEST(MapMerger, RefusesAnOverlapThatLeavesADirectionOpen) {
  const PriorMap tunnel = testing::mapped_along_x(testing::smooth_tunnel(), 5.0);
  EXPECT_THAT(align_maps(tunnel, tunnel, Pose{}).refusal, HasSubstr("5 of 6 directions"));
}

TEST(MapSupport, IsTheLeastShareOverTheDirectionsThatCount) {
  Matrix6d expected = Matrix6d::Identity() * 1e6;
  expected(5, 5) = 10.0;  // degenerate: does not count
  Matrix6d found = 0.8 * expected;
  found(3, 3) = 0.2 * expected(3, 3);
  found(5, 5) = 0.0;
  EXPECT_NEAR(map_support(expected, found, 5000.0), 0.2, 1e-12);
  EXPECT_EQ(map_support(Matrix6d::Zero(), found, 5000.0), 0.0);
}

/// A field from the air: its bumps lean normals by some degrees, and that says nothing of where above it one is.
TEST(MapSupport, TheScatterOfNormalsIsNoKnowledge) {
  RandomStream random(1, "field");
  std::vector<FeaturePoint> field(2000);
  for (FeaturePoint& f : field) {
    f.position = Eigen::Vector3d(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), -20.0).cast<float>();
    f.normal = Eigen::Vector3d(0.05 * random.gaussian(), 0.05 * random.gaussian(), 1.0).normalized().cast<float>();
  }
  constexpr double kThreshold = 5000.0;
  EXPECT_GT(plane_information(field, 0.02, 0.0)(3, 3), kThreshold);
  EXPECT_LT(plane_information(field, 0.02, kNormalSigma)(3, 3), kThreshold);
  EXPECT_GT(plane_information(field, 0.02, kNormalSigma)(5, 5), 100.0 * kThreshold);
}

}  // namespace
}  // namespace plumbline
