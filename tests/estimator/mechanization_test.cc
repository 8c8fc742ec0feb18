#include "estimator/imu/mechanization.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensors/imu.h"
#include "tests/support/aggressive_motion.h"

namespace plumbline {
namespace {

struct EndError {
  double position_m = 0.0;
  double attitude_rad = 0.0;
};

NavigationState true_state(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const MotionState truth = trajectory.at(stamp_ns);
  NavigationState state;
  state.stamp_ns = stamp_ns;
  state.world_from_body = truth.world_from_body;
  state.velocity_in_world = truth.velocity_in_world;
  return state;
}

EndError reintegrate(const Trajectory& trajectory, std::int64_t period_ns, std::int64_t end_ns) {
  NavigationState state = true_state(trajectory, 0);
  ImuSample previous = exact_sample(trajectory, -period_ns, 0);
  for (std::int64_t t = period_ns; t <= end_ns; t += period_ns) {
    const ImuSample sample = exact_sample(trajectory, t - period_ns, t);
    state = mechanize(state, segment_between(previous, sample));
    previous = sample;
  }
  const Vector6d error = true_state(trajectory, end_ns).world_from_body.local(state.world_from_body);
  return {error.tail<3>().norm(), error.head<3>().norm()};
}

TEST(Mechanization, ErrorFallsWithTheSquareOfTheIntervalOrFaster) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const std::int64_t end_ns = 60'000'000'000;
  ASSERT_GE(trajectory.end_ns(), end_ns);
  const EndError coarse = reintegrate(trajectory, 10'000'000, end_ns);
  const EndError fine = reintegrate(trajectory, 1'250'000, end_ns);
  // Three octaves from 100 to 800 Hz.
  const double slope = std::log2(coarse.position_m / fine.position_m) / 3.0;
  RecordProperty("slope", std::to_string(slope));
  EXPECT_GE(slope, 1.9) << coarse.position_m << " m at 100 Hz, " << fine.position_m << " m at 800 Hz";
  // What a perfect 800 Hz unit may leave after a minute: far below any estimator's drift.
  EXPECT_LE(fine.position_m, 0.02);
  EXPECT_LE(fine.attitude_rad, 0.02 * M_PI / 180.0);
}

TEST(Mechanization, SplittingAnIntervalChangesNothing) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const std::int64_t t = 7'000'000'000;
  const std::int64_t period = 5'000'000;
  const InertialSegment whole =
      segment_between(exact_sample(trajectory, t - period, t), exact_sample(trajectory, t, t + period));
  const NavigationState start = true_state(trajectory, t);
  const NavigationState once = mechanize(start, whole);
  const NavigationState twice =
      mechanize(mechanize(start, whole.part(t, t + 2'000'000)), whole.part(t + 2'000'000, t + period));
  // Both carry the same straight line of rate and force; what is left is of fourth order in 5 ms.
  const Vector6d difference = once.world_from_body.local(twice.world_from_body);
  EXPECT_LT(difference.norm(), 1e-8);
  EXPECT_LT((once.velocity_in_world - twice.velocity_in_world).norm(), 1e-6);
}

TEST(Mechanization, RemovesBiases) {
  NavigationState state;
  state.gyro_bias = {0.01, -0.02, 0.03};
  state.accel_bias = {0.2, -0.1, 0.3};
  ImuSample sample;
  sample.angular_rate = state.gyro_bias;
  sample.specific_force = state.accel_bias + Eigen::Vector3d(0, 0, kStandardGravity);
  for (int k = 1; k <= 200; ++k) {
    ImuSample next = sample;
    next.stamp_ns = k * 5'000'000LL;
    ImuSample before = sample;
    before.stamp_ns = (k - 1) * 5'000'000LL;
    state = mechanize(state, segment_between(before, next));
  }
  EXPECT_LT(state.world_from_body.translation.norm(), 1e-9);
  EXPECT_LT(state.velocity_in_world.norm(), 1e-9);
}

}  // namespace
}  // namespace plumbline
