#include "estimator/lidar/deskew.h"

#include <gtest/gtest.h>

#include "tests/support/box_world.h"

namespace plumbline {
namespace {

using testing::vlp16_scan;

const Pose kBodyFromLidar = {rotation_from_rpy({0.02, 0.3, -0.1}), {0.2, -0.05, 0.4}};

Pose hard_turn(double t) {
  return {rotation_from_rpy({0.3 * std::sin(6.0 * t), 0.2 * std::sin(5.0 * t), 2.0 * t}),
          {4.0 * t, -1.0 * t * t, 0.3 * t}};
}

PoseTrack imu_track(double from_s, double to_s) {
  PoseTrack track;
  for (double t = from_s; t <= to_s; t += 0.005)
    track.push(static_cast<std::int64_t>(std::llround(t * 1e9)), hard_turn(t));
  return track;
}

double worst_distance_to_walls(const LidarScan& scan, const PoseTrack& track, std::int64_t reference_ns) {
  const testing::BoxWorld world = testing::furnished_room();
  double worst = 0.0;
  for (const Eigen::Vector3f& p : deskew(scan, track, kBodyFromLidar, reference_ns).points) {
    worst = std::max(worst, world.distance(hard_turn(1e-9 * static_cast<double>(reference_ns)) * p.cast<double>()));
  }
  return worst;
}

TEST(Deskew, PutsAScanTakenInMotionOnTheWalls) {
  RandomStream noise(1, "lidar");
  const LidarScan scan = vlp16_scan(testing::furnished_room(), hard_turn, 100'000'000, kBodyFromLidar, 0.0, noise);
  const PoseTrack track = imu_track(0.0, 0.3);
  // 2 rad/s, 4 m/s: without de-skewing the error is metres. Poses every 5 ms, interpolated at constant rate, err by
  // acceleration * dt^2 / 8: 12 rad/s^2 over 10 m make 0.4 mm.
  for (const std::int64_t reference : {scan.stamp_ns, scan.end_ns, scan.stamp_ns + 33'333'333}) {
    EXPECT_LT(worst_distance_to_walls(scan, track, reference), 1e-3) << reference;
  }
}

TEST(Deskew, OfAScanAtRestOnlyAppliesTheExtrinsics) {
  RandomStream noise(1, "lidar");
  const auto rest = [](double) { return Pose{}; };
  const LidarScan scan = vlp16_scan(testing::furnished_room(), rest, 0, kBodyFromLidar, 0.0, noise);
  PoseTrack track;
  track.push(0, {});
  const auto points = deskew(scan, track, kBodyFromLidar, scan.end_ns).points;
  ASSERT_EQ(points.size(), scan.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d expected = kBodyFromLidar * scan.points[i].position.cast<double>();
    EXPECT_LT((points[i].cast<double>() - expected).norm(), 1e-5);
  }
}

TEST(Deskew, KnowsWhereTheLidarStood) {
  LidarScan scan;
  scan.end_ns = 100'000'000;
  const DeskewedScan deskewed = deskew(scan, imu_track(0.0, 0.3), kBodyFromLidar, scan.end_ns);
  const Pose end_from_world = hard_turn(0.1).inverse();
  for (const std::int64_t offset : {0, 33'333'333, 100'000'000}) {
    const Pose then = hard_turn(1e-9 * static_cast<double>(offset));
    const Eigen::Vector3d expected = (end_from_world * then * kBodyFromLidar).translation;
    // As above, with a lever arm in place of the range.
    EXPECT_LT((deskewed.origin(offset).cast<double>() - expected).norm(), 1e-4) << offset;
  }
  EXPECT_EQ(deskewed.origin(-5), deskewed.origin(0));
  EXPECT_TRUE(deskewed.origin(2'000'000'000).allFinite());
}

TEST(Deskew, HoldsStampsOutsideTheScanAtItsEnds) {
  LidarScan scan;
  scan.stamp_ns = 0;
  scan.end_ns = 100'000'000;
  for (const std::int32_t offset : {-5, 2'000'000'000}) {
    LidarPoint point;
    point.position = {1.0F, 0.0F, 0.0F};
    point.offset_ns = offset;
    scan.points.push_back(point);
  }
  for (const auto& p : deskew(scan, imu_track(0.0, 0.3), {}, 0).points) EXPECT_TRUE(p.allFinite());
  EXPECT_TRUE(deskew(LidarScan{}, imu_track(0.0, 0.1), {}, 0).points.empty());
}

}  // namespace
}  // namespace plumbline
