#include "estimator/imu/mechanization.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensors/imu.h"
#include "tests/support/aggressive_motion.h"
#include "tests/support/true_state.h"

namespace plumbline {
namespace {

TEST(Mechanization, SplittingAnIntervalChangesNothing) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  const std::int64_t t = 7'000'000'000;
  const std::int64_t period = 5'000'000;
  const InertialSegment whole =
      segment_between(exact_sample(trajectory, t - period, t), exact_sample(trajectory, t, t + period));
  const NavigationState start = testing::true_state(trajectory, t);
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
