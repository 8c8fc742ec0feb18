#include "sensors/imu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/aggressive_motion.h"

namespace plumbline {
namespace {

Trajectory resting() {
  std::vector<PoseTrack::Stamped> poses;
  for (int i = 0; i < 5; ++i) poses.push_back({i * 1'000'000'000LL, {}});
  return Trajectory(poses);
}

TEST(Imu, AtRestReadsGravityUpward) {
  const ImuSample s = exact_sample(resting(), 0, 5'000'000);
  EXPECT_NEAR((s.specific_force - Eigen::Vector3d(0, 0, 9.81)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(s.angular_rate.norm(), 0.0, 1e-12);
}

TEST(Imu, SampleIsTheMeanOverItsInterval) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const std::int64_t start = 6'000'000'000;
  const std::int64_t period = 10'000'000;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    mean +=
        trajectory.at_seconds((static_cast<double>(start) + (i + 0.5) / n * period) * 1e-9).angular_rate_in_body / n;
  }
  // The midpoint sum errs by (interval / n)^2 times a second derivative.
  EXPECT_LT((exact_sample(trajectory, start, start + period).angular_rate - mean).norm(), 1e-8);
}

TEST(Imu, WhiteNoiseHasTheDataSheetsDensity) {
  ImuModel model;
  model.noise.gyro_turn_on_sigma = model.noise.accel_turn_on_sigma = 0.0;
  model.noise.gyro_random_walk = model.noise.accel_random_walk = 0.0;
  Imu imu(model, 7);
  const Trajectory rest = resting();
  const int n = 4000;
  double gyro = 0.0;
  double accel = 0.0;
  for (int k = 1; k <= n; ++k) {
    const ImuSample s = imu.sample(rest, k * imu.period_ns());
    gyro += s.angular_rate.squaredNorm() / (3.0 * n);
    accel += (s.specific_force - Eigen::Vector3d(0, 0, 9.81)).squaredNorm() / (3.0 * n);
  }
  // 12,000 draws: the standard deviation's own relative error is 1/sqrt(24000) = 0.65 %; five of those.
  EXPECT_NEAR(std::sqrt(gyro), 2.4e-4 * std::sqrt(200.0), 0.033 * 2.4e-4 * std::sqrt(200.0));
  EXPECT_NEAR(std::sqrt(accel), 1.5e-3 * std::sqrt(200.0), 0.033 * 1.5e-3 * std::sqrt(200.0));
}

TEST(Imu, TurnOnBiasIsDrawnPerSeed) {
  ImuModel model;
  model.noise.gyro_density = model.noise.accel_density = 0.0;
  model.noise.gyro_random_walk = model.noise.accel_random_walk = 0.0;
  const Trajectory rest = resting();
  double sum = 0.0;
  const int n = 400;
  for (int seed = 0; seed < n; ++seed) {
    Imu imu(model, static_cast<std::uint64_t>(seed));
    sum += (imu.sample(rest, imu.period_ns()).specific_force - Eigen::Vector3d(0, 0, 9.81)).squaredNorm() / (3.0 * n);
  }
  EXPECT_NEAR(std::sqrt(sum), 0.2, 0.2 * 5.0 / std::sqrt(2.0 * 3.0 * n));
}

}  // namespace
}  // namespace plumbline
