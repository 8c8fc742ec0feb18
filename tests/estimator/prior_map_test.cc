#include "estimator/localization/prior_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "estimator/geometry/so3.h"
#include "estimator/localization/smooth_correction.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();
const Eigen::Vector3f kEdge = Eigen::Vector3f::Zero();

std::string complaint(PriorMapBuilder& builder) {
  try {
    builder.build();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(PriorMap, KeepsOnePointACellAndSide) {
  PriorMapBuilder builder(true);
  for (int k = 0; k < 100; ++k) builder.add({0.05, 0.05, 0.01 * (k % 2)}, kUp, 0.5F);
  builder.add({0.05, 0.05, 0.0}, -kUp, 0.5F);
  builder.add({0.05, 0.05, 0.0}, kEdge, 0.5F);
  const PriorMap map = builder.build();
  ASSERT_EQ(map.surfaces.planes.size(), 2u);
  EXPECT_EQ(map.surfaces.edges.size(), 1u);
  EXPECT_NEAR(map.surfaces.planes.front().position.z(), 0.005F, 1e-6F);
  EXPECT_EQ(map.points, 102);
}

TEST(PriorMap, FindsNormalsWhereNoneAreGivenAndTakesBothSides) {
  PriorMapBuilder builder(false);
  RandomStream random(1, "wall");
  for (int k = 0; k < 5000; ++k) {
    builder.add({random.uniform(0.0, 4.0), 0.005 * random.gaussian(), random.uniform(0.0, 3.0)}, kEdge, 0.0F);
  }
  const PriorMap map = builder.build();
  ASSERT_GT(map.surfaces.planes.size(), 400u);
  double along = 0.0;
  for (const FeaturePoint& f : map.surfaces.planes) {
    EXPECT_GT(std::abs(f.normal.y()), 0.98F);
    along += static_cast<double>(f.normal.y());
  }
  EXPECT_NEAR(along, 0.0, 1e-3);
}

TEST(PriorMap, SaysWhatIsWrongWithAMap) {
  PriorMapBuilder empty(true);
  EXPECT_EQ(complaint(empty), "it has no points");
  PriorMapBuilder not_finite(true);
  not_finite.add({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, kUp, 0.0F);
  EXPECT_EQ(complaint(not_finite), "none of its points is finite");
  PriorMapBuilder far(true);
  EXPECT_THROW(far.add({450'000.0, 0.0, 0.0}, kUp, 0.0F), std::invalid_argument);
}

TEST(PriorMap, CountsWhatItLeavesOut) {
  PriorMapBuilder builder(true);
  builder.add({1.0, 2.0, 3.0}, kUp, 0.0F);
  builder.add({1.0, std::numeric_limits<double>::infinity(), 3.0}, kUp, 0.0F);
  const PriorMap map = builder.build();
  EXPECT_EQ(map.points, 1);
  EXPECT_EQ(map.unusable, 1);
  EXPECT_EQ(map.distance({1.0, 2.0, 5.0}), 2.0);
}

// A plain of 250 x 250 m at a point a decimetre needs three times as many cells as are allowed.
TEST(PriorMap, ALargeMapGetsLargerCellsAndNoMoreMemory) {
  PriorMapBuilder builder(true);
  for (int i = 0; i < 2500; ++i) {
    for (int k = 0; k < 2500; ++k) builder.add({0.1 * i + 0.05, 0.1 * k + 0.05, 0.0}, kUp, 0.0F);
  }
  const PriorMap map = builder.build();
  EXPECT_EQ(map.points, 6'250'000);
  EXPECT_EQ(map.cell_m, 0.2);
  EXPECT_LE(map.surfaces.planes.size(), PriorMapBuilder::kMostCells);
}

TEST(SmoothCorrection, ReachesItsAimAndStartsAndEndsAtRest) {
  SmoothCorrection correction({}, 1.0);
  const Pose body{exp_so3({0.0, 0.0, 0.3}), {100.0, 0.0, 0.0}};
  const Pose aim{exp_so3({0.0, 0.0, 0.01}), {-0.2, 0.1, 0.0}};
  correction.aim(0, body, aim);
  EXPECT_LT(body.local(correction.map_from_body(0, body)).norm(), 1e-12);
  EXPECT_LT((aim * body).local(correction.map_from_body(1'000'000'000, body)).norm(), 1e-12);
  // 3 s^2 of the way after so small a share s.
  const double moved = (correction.map_from_body(10'000'000, body).translation - body.translation).norm();
  EXPECT_LT(moved, 3.1e-4 * ((aim * body).translation - body.translation).norm());
}

TEST(SmoothCorrection, ANewAimStartsFromWhereItIs) {
  SmoothCorrection correction({}, 1.0);
  const Pose body{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  correction.aim(0, body, {Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0}});
  const Pose midway = correction.map_from_body(500'000'000, body);
  correction.aim(500'000'000, body, {Eigen::Quaterniond::Identity(), {-0.2, 0.0, 0.0}});
  EXPECT_LT(midway.local(correction.map_from_body(500'000'000, body)).norm(), 1e-12);
}

}  // namespace
}  // namespace plumbline
