#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimator/estimator.h"
#include "sensors/imu.h"
#include "tests/support/aggressive_motion.h"

namespace plumbline {
namespace {

Calibration camera_calibration() {
  Calibration calibration;
  calibration.camera = {64, 36, 47.0, 47.0, 31.5, 17.5};
  return calibration;
}

ImuSample resting_sample(std::int64_t stamp_ns) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  sample.specific_force = {0.0, 0.0, 9.81};
  return sample;
}

void rest_for(Estimator& estimator, double seconds) {
  for (std::int64_t k = 1; k <= static_cast<std::int64_t>(seconds * 200.0); ++k) {
    estimator.add(resting_sample(k * 5'000'000));
  }
}

TEST(Pipeline, GivesOneOutputPerImuSampleFromTheFirstOn) {
  const auto estimator = make_estimator("vloam", camera_calibration(), {});
  rest_for(*estimator, 1.5);
  const auto outputs = estimator->take();
  ASSERT_EQ(outputs.size(), 300u);
  EXPECT_EQ(outputs.front().stamp_ns, 5'000'000);
  // Perfect samples at rest: nothing moves, neither before nor after the start.
  for (const Odometry& o : outputs) EXPECT_LT(o.world_from_body.translation.norm(), 1e-9);
  EXPECT_TRUE(estimator->take().empty());
}

TEST(Pipeline, FurtherCamerasAreCountedAndLeftAlone) {
  const auto estimator = make_estimator("vloam", camera_calibration(), {});
  rest_for(*estimator, 1.5);
  const std::int64_t stamp_ns = 1'510'000'000;
  const std::vector<std::uint8_t> pixels(64 * 36, 100);
  estimator->add(CameraFrame{stamp_ns, 1, 64, 36, pixels});
  estimator->add(DepthFrame{stamp_ns, 2, 64, 36, std::vector<float>(64 * 36, 2.0F)});
  estimator->add(CameraFrame{stamp_ns, 0, 64, 36, pixels});
  estimator->add(resting_sample(1'520'000'000));
  const MessageCounts counts = estimator->counts(Module::kVision);
  EXPECT_EQ(counts.used, 1);
  EXPECT_EQ(counts.dropped.at("further cameras are not used"), 1);
  EXPECT_EQ(counts.dropped.at("depth images are not used"), 1);
}

TEST(Pipeline, StartsAtTheOriginLevelWithYawZero) {
  Calibration calibration = camera_calibration();
  const auto estimator = make_estimator("imu", calibration, {});
  const Eigen::Quaterniond tilt = rotation_from_rpy({0.1, -0.2, 0.0});
  for (std::int64_t k = 1; k <= 300; ++k) {
    ImuSample sample;
    sample.stamp_ns = k * 5'000'000;
    sample.specific_force = tilt.conjugate() * Eigen::Vector3d(0.0, 0.0, 9.81);
    estimator->add(sample);
  }
  const Pose pose = estimator->take().back().world_from_body;
  EXPECT_LT(pose.rotation.angularDistance(tilt), 1e-9);
  EXPECT_LT(pose.translation.norm(), 1e-9);
}

TEST(Pipeline, CountsAndDropsWhatItCannotUse) {
  const auto estimator = make_estimator("vloam", camera_calibration(), {});
  rest_for(*estimator, 1.2);
  ImuSample bad = resting_sample(1'300'000'000);
  bad.angular_rate.x() = std::numeric_limits<double>::quiet_NaN();
  estimator->add(bad);
  estimator->add(resting_sample(1'000'000'000));
  estimator->add(LidarScan{});
  estimator->add(CameraFrame{});
  CameraFrame late;
  late.width = 64;
  late.height = 36;
  late.pixels.resize(64 * 36);
  late.stamp_ns = 1'000'000;
  estimator->add(late);
  EXPECT_EQ(estimator->counts(Module::kImu).dropped.at("not finite"), 1);
  EXPECT_EQ(estimator->counts(Module::kImu).dropped.at("back in time"), 1);
  EXPECT_EQ(estimator->counts(Module::kLidar).dropped.at("empty"), 1);
  EXPECT_EQ(estimator->counts(Module::kVision).dropped.at("wrong size"), 1);
  EXPECT_EQ(estimator->counts(Module::kVision).dropped.at("late"), 1);
  EXPECT_TRUE(estimator->take().back().world_from_body.translation.allFinite());
}

TEST(Pipeline, SurvivesPointsThatAreNotFinite) {
  const auto estimator = make_estimator("imu_lidar", camera_calibration(), {});
  rest_for(*estimator, 1.5);
  LidarScan scan;
  scan.stamp_ns = 1'300'000'000;
  scan.end_ns = 1'400'000'000;
  LidarPoint point;
  point.position.setConstant(std::numeric_limits<float>::quiet_NaN());
  scan.points.assign(500, point);
  point.position = {std::numeric_limits<float>::infinity(), 1.0F, 1e30F};
  scan.points.resize(1000, point);
  estimator->add(scan);
  estimator->add(resting_sample(1'505'000'000));
  EXPECT_TRUE(estimator->take().back().world_from_body.translation.allFinite());
}

TEST(Pipeline, DeadReckoningFollowsAPerfectImu) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const auto estimator = make_estimator("imu", camera_calibration(), {});
  const std::int64_t period = 5'000'000;
  for (std::int64_t t = period; t <= 10'000'000'000; t += period) {
    estimator->add(exact_sample(trajectory, t - period, t));
  }
  const auto outputs = estimator->take();
  const Pose start_from_world = outputs[100].world_from_body * trajectory.pose(outputs[100].stamp_ns).inverse();
  const Pose truth = start_from_world * trajectory.pose(10'000'000'000);
  // Eight seconds of flight on noise-free 200 Hz samples: integration error only, millimetres.
  EXPECT_LT(truth.local(outputs.back().world_from_body).tail<3>().norm(), 0.02);
}

TEST(Pipeline, RefusesUnknownNamesAndImpossibleCameras) {
  EXPECT_THROW(make_estimator("slam", camera_calibration(), {}), std::invalid_argument);
  EXPECT_THROW(make_estimator("vloam", Calibration{}, {}), std::invalid_argument);
  for (const EstimatorInfo& info : estimator_library()) {
    EXPECT_NE(make_estimator(info.name, camera_calibration(), {}), nullptr) << info.name;
  }
}

}  // namespace
}  // namespace plumbline
