#include "sim/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "estimator/geometry/so3.h"
#include "sim/motion.h"
#include "tests/support/aggressive_motion.h"

namespace plumbline {
namespace {

TEST(Trajectory, VelocityAndAccelerationAreTheDerivativesOfPosition) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const double h = 1e-4;
  for (double t = 3.0013; t < 20.0; t += 0.7131) {
    const MotionState before = trajectory.at_seconds(t - h);
    const MotionState now = trajectory.at_seconds(t);
    const MotionState after = trajectory.at_seconds(t + h);
    // Central differences of a cubic err by h^2 / 6 times its third derivative, here below 1e-5.
    EXPECT_LT(
        ((after.world_from_body.translation - before.world_from_body.translation) / (2 * h) - now.velocity_in_world)
            .norm(),
        1e-4);
    EXPECT_LT(((after.velocity_in_world - before.velocity_in_world) / (2 * h) - now.acceleration_in_world).norm(),
              1e-2);
  }
}

TEST(Trajectory, AngularRateIsTheDerivativeOfAttitude) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const double h = 1e-4;
  for (double t = 3.0013; t < 20.0; t += 0.7131) {
    const MotionState before = trajectory.at_seconds(t - h);
    const MotionState now = trajectory.at_seconds(t);
    const MotionState after = trajectory.at_seconds(t + h);
    const Eigen::Vector3d rate =
        log_so3(before.world_from_body.rotation.conjugate() * after.world_from_body.rotation) / (2 * h);
    EXPECT_LT((rate - now.angular_rate_in_body).norm(), 1e-4);
    EXPECT_LT(((after.angular_rate_in_body - before.angular_rate_in_body) / (2 * h) - now.angular_acceleration_in_body)
                  .norm(),
              0.05);
  }
}

TEST(Trajectory, RejectsTooFewPosesAndStampsThatDoNotIncrease) {
  EXPECT_THROW(Trajectory({{0, {}}, {1, {}}}), std::invalid_argument);
  EXPECT_THROW(Trajectory({{0, {}}, {2, {}}, {2, {}}, {3, {}}}), std::invalid_argument);
}

TEST(Motion, StartsWithATrueRest) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  for (double t = 0.1; t < 2.0; t += 0.1) {
    const MotionState s = trajectory.at_seconds(t);
    // The spline's ringing before the first motion falls by 0.27 a knot.
    EXPECT_LT(s.velocity_in_world.norm(), 1e-6) << t;
    EXPECT_LT(s.angular_rate_in_body.norm(), 1e-6) << t;
  }
}

TEST(Motion, KeepsToTheLegsBetweenWaypoints) {
  MotionConfig config;
  config.waypoints = {{{0, 0, 1.5}}, {{10, 0, 1.5}}, {{10, 10, 1.5}}};
  config.speed_mps = 1.5;
  const Trajectory trajectory = make_trajectory(config, 1);
  const double end_s = static_cast<double>(trajectory.end_ns()) * 1e-9;
  for (double t = 0.0; t < end_s; t += 0.05) {
    const Eigen::Vector3d p = trajectory.at_seconds(t).world_from_body.translation;
    const double to_first = std::hypot(std::max(0.0, p.x() - 10.0), p.y());
    const double to_second = std::hypot(p.x() - 10.0, std::max(0.0, -p.y()));
    // A 90 degree corner is cut by at most speed times a quarter of the smoothing time.
    EXPECT_LT(std::min(to_first, to_second), 0.45) << t;
    EXPECT_NEAR(p.z(), 1.5, 1e-9);
  }
  EXPECT_LT((trajectory.pose(trajectory.end_ns()).translation - Eigen::Vector3d(10, 10, 1.5)).norm(), 1e-6);
}

TEST(Motion, SpeedFactorShortensTheDriveOnly) {
  MotionConfig config;
  config.waypoints = {{{0, 0, 1}}, {{30, 0, 1}}};
  const double slow = static_cast<double>(make_trajectory(config, 1).end_ns());
  config.speed_factor = 2.0;
  const double fast = static_cast<double>(make_trajectory(config, 1).end_ns());
  const double still = (2.0 + 2.0 * 1.2) * 1e9;  // the rest and the smoothing at both ends do not scale
  EXPECT_NEAR((slow - still) / (fast - still), 2.0, 0.02);
}

class TumMotion : public ::testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(path_) << text; }
  void TearDown() override { std::filesystem::remove(path_); }
  MotionConfig config() const {
    MotionConfig motion;
    motion.tum_file = path_;
    return motion;
  }
  std::filesystem::path path_ = std::filesystem::path(::testing::TempDir()) / "plumbline_motion_test.tum";
};

TEST_F(TumMotion, PassesThroughTheFilesPosesFromTimeZero) {
  write(
      "# recorded\n100.0 0 0 1 0 0 0 1\n100.5 1 0 1 0 0 0 1\n101.0 2 0.5 1 0 0 0.1736482 0.9848078\n"
      "101.5 3 1 1 0 0 0.3420201 0.9396926\n102.0 4 2 1 0 0 0.5 0.8660254\n");
  const Trajectory trajectory = make_trajectory(config(), 1);
  EXPECT_EQ(trajectory.start_ns(), 0);
  EXPECT_EQ(trajectory.end_ns(), 2'000'000'000);
  const Pose middle = trajectory.pose(1'000'000'000);
  EXPECT_LT((middle.translation - Eigen::Vector3d(2.0, 0.5, 1.0)).norm(), 1e-12);
  // A quaternion of 10 degrees about z, twice: 20 degrees, given to seven digits.
  EXPECT_NEAR(rpy_from_rotation(middle.rotation).z(), 20.0 * M_PI / 180.0, 1e-6);
}

TEST_F(TumMotion, SpeedFactorShortensTheFilesTimes) {
  write("0 0 0 1 0 0 0 1\n1 1 0 1 0 0 0 1\n2 2 0 1 0 0 0 1\n3 3 0 1 0 0 0 1\n");
  MotionConfig motion = config();
  motion.speed_factor = 2.0;
  EXPECT_EQ(make_trajectory(motion, 1).end_ns(), 1'500'000'000);
}

TEST_F(TumMotion, NamesTheFileThatItCannotUse) {
  write("0 0 0 1 0 0 0 1\n1 1 0 1 0 0 0 1\n");
  EXPECT_THAT([&] { make_trajectory(config(), 1); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("plumbline_motion_test.tum")));
  write("0 0 0 1 0 0 0 1\n1 nan 0 1 0 0 0 1\n");
  EXPECT_THAT([&] { make_trajectory(config(), 1); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("plumbline_motion_test.tum:2")));
}

TEST(Motion, SaysWhatIsWrong) {
  MotionConfig config;
  config.waypoints = {{{0, 0, 1}}};
  EXPECT_THROW(make_trajectory(config, 1), std::invalid_argument);
  config.waypoints = {{{0, 0, 1}}, {{0, 0, 1}}};
  EXPECT_THROW(make_trajectory(config, 1), std::invalid_argument);
}

/// Control poses of an aggressive motion, 2 ms apart.
Pose control_at(std::int64_t stamp_ns) {
  static const Trajectory motion = make_trajectory(testing::aggressive_motion(), 1);
  return motion.pose(stamp_ns + 3'000'000'000);
}

TEST(GrowingTrajectory, FollowsItsControlPosesAndWhatIsKnownStays) {
  constexpr std::int64_t kStep_ns = 2'000'000;
  Trajectory growing(control_at(0), 0, kStep_ns);
  std::vector<MotionState> seen;
  std::vector<std::int64_t> stamps;
  for (std::int64_t t = kStep_ns; t <= 1'000'000'000; t += kStep_ns) {
    growing.extend(control_at(t));
    EXPECT_EQ(growing.end_ns(), t - kStep_ns);
    if (t < 100'000'000) continue;
    stamps.push_back(t - 2 * kStep_ns + 700'000);
    seen.push_back(growing.at(stamps.back()));
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const MotionState now = growing.at(stamps[i]);
    ASSERT_EQ(now.world_from_body.translation, seen[i].world_from_body.translation);
    ASSERT_EQ(now.acceleration_in_world, seen[i].acceleration_in_world);
    // The spline's knots average their neighbours: off by a step^2 / 6 of the acceleration, 20 um at 3 g.
    EXPECT_LT((now.world_from_body.translation - control_at(stamps[i]).translation).norm(), 5e-5);
  }
}

TEST(GrowingTrajectory, RestsUntilItBegins) {
  const Trajectory growing(control_at(0), 0, 2'000'000);
  EXPECT_LT((growing.pose(0).translation - control_at(0).translation).norm(), 1e-12);
  EXPECT_EQ(growing.at(-1'000'000'000).velocity_in_world.norm(), 0.0);
  EXPECT_THROW(Trajectory(Pose{}, 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
