#include "sensors/imu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/rig_driver.h"
#include "tests/sim/vehicle_world.h"
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

TEST(Imu, SamplesSpanTheKnotsOfAMotionThatIsNotSmooth) {
  const World world = testing::vehicle_world();
  MotionConfig config = testing::by_vehicle("runner", "straight");
  config.route_length_m = 6.0;
  const Trajectory runner = mounted_on(make_trajectory(config, world, RayScene(world), 1), {});
  const std::int64_t period_ns = 10'000'000;  // two of the runner's knots
  double force = 0.0;
  double rate = 0.0;
  for (std::int64_t start_ns = 0; start_ns + period_ns < runner.end_ns(); start_ns += 7 * 2'500'000) {
    ImuSample mean;
    const int n = 4000;  // midpoints between the knots, where a midpoint sum errs by h^2 times the curvature
    for (int i = 0; i < n; ++i) {
      const MotionState s = runner.at_seconds((static_cast<double>(start_ns) + (i + 0.5) / n * period_ns) * 1e-9);
      mean.angular_rate += s.angular_rate_in_body / n;
      mean.specific_force +=
          s.world_from_body.rotation.conjugate() * (s.acceleration_in_world + 9.81 * Eigen::Vector3d::UnitZ()) / n;
    }
    const ImuSample sample = exact_sample(runner, start_ns, start_ns + period_ns);
    force = std::max(force, (sample.specific_force - mean.specific_force).norm());
    rate = std::max(rate, (sample.angular_rate - mean.angular_rate).norm());
  }
  EXPECT_LT(force, 1e-6);
  EXPECT_LT(rate, 1e-7);
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

TEST(Imu, LeverArmGivesTheAccelerationOfThePointItself) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const Eigen::Vector3d arm(0.3, -0.2, 0.1);
  const auto place = [&](double time_s) { return trajectory.at_seconds(time_s).world_from_body * arm; };
  const double h = 1e-3;
  // Halfway between knots, which are 10 ms apart: across one the differences would not see the acceleration's bend.
  for (double time_s = 5.005; time_s < 30.0; time_s += 1.37) {
    const Eigen::Vector3d acceleration = (place(time_s + h) - 2.0 * place(time_s) + place(time_s - h)) / (h * h);
    const MotionState state = trajectory.at_seconds(time_s);
    const Eigen::Vector3d force =
        state.world_from_body.rotation.conjugate() * (acceleration + 9.81 * Eigen::Vector3d::UnitZ());
    const auto stamp_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
    const ImuSample sample = exact_sample(trajectory, stamp_ns - 50'000, stamp_ns + 50'000, arm);
    // Second differences err by h^2 / 12 times a fourth derivative (of the arm's swing some 1e3 m/s^4).
    EXPECT_LT((sample.specific_force - force).norm(), 1e-3) << time_s;
  }
}

TEST(Imu, ClipsAtItsRangeAndRoundsToItsStep) {
  ImuModel model;
  model.gyro = {0.0, 0.0, 2.0, 0.25};
  Imu imu(model, 3);
  ImuSample truth;
  truth.angular_rate = {5.0, -5.0, 1.1};
  const ImuSample sample = imu.measured(truth);
  EXPECT_EQ(sample.angular_rate.x(), 2.0);
  EXPECT_EQ(sample.angular_rate.y(), -2.0);
  // Biases and noise are far below half a step.
  EXPECT_EQ(sample.angular_rate.z(), 1.0);
}

TEST(Imu, AnEffectSwitchedOffLeavesTheOthersNoiseAsItWas) {
  ImuModel with;
  ImuModel without;
  without.effects.turn_on_bias = false;
  Imu first(with, 5);
  Imu second(without, 5);
  const ImuSample truth;
  const Eigen::Vector3d bias = first.measured(truth).angular_rate - second.measured(truth).angular_rate;
  const Eigen::Vector3d later = first.measured(truth).angular_rate - second.measured(truth).angular_rate;
  EXPECT_GT(bias.norm(), 0.0);
  EXPECT_LT((later - bias).norm(), 1e-15);
}

TEST(Imu, TurnOnBiasCanBeGiven) {
  ImuModel model;
  model.noise = {};
  model.noise.gyro_density = model.noise.gyro_random_walk = 0.0;
  model.gyro_turn_on_bias = Eigen::Vector3d(0.0, 0.0, 0.002);
  Imu imu(model, 1);
  EXPECT_EQ(imu.measured({}).angular_rate, Eigen::Vector3d(0.0, 0.0, 0.002));
}

TEST(Imu, VibratesWithItsRmsAndWithSpeed) {
  const VibrationModel model{0.5, 0.1, 10.0, 40.0};
  const Vibration vibration(model, 1);
  double square_sum = 0.0;
  const int n = 20'000;
  for (std::int64_t k = 0; k < n; ++k) {
    square_sum += vibration.mean(k * 1'000'000, (k + 1) * 1'000'000, 5.0).squaredNorm() / (3.0 * n);
  }
  // Averaging over 1 ms takes less than 0.3 % off tones below 40 Hz; tones close in frequency beat over the 20 s.
  EXPECT_NEAR(std::sqrt(square_sum), 0.5 + 0.1 * 5.0, 0.03);
}

}  // namespace
}  // namespace plumbline
