// The whole chain from motion to inertial samples and back, without noise: what is left is integration error.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "estimator/imu/mechanization.h"
#include "scenarios/session.h"
#include "sensors/imu.h"
#include "tests/scenarios/body_trajectory.h"
#include "tests/support/true_state.h"

namespace plumbline {
namespace {

constexpr std::int64_t kEnd_ns = 60'000'000'000;

struct EndError {
  double position_m = 0.0;
  double attitude_rad = 0.0;
};

EndError reintegrate(const Trajectory& trajectory, double rate_hz) {
  const std::int64_t period_ns = std::llround(1e9 / rate_hz);
  NavigationState state = testing::true_state(trajectory, 0);
  ImuSample previous = exact_sample(trajectory, -period_ns, 0);
  for (std::int64_t t = period_ns; t <= kEnd_ns; t += period_ns) {
    const ImuSample sample = exact_sample(trajectory, t - period_ns, t);
    state = mechanize(state, segment_between(previous, sample));
    previous = sample;
  }
  const Vector6d error = testing::true_state(trajectory, kEnd_ns).world_from_body.local(state.world_from_body);
  return {error.tail<3>().norm(), error.head<3>().norm()};
}

TEST(Reintegration, ErrorOverAMinuteOfFlightFallsWithTheSquareOfTheIntervalOrFaster) {
  const auto path = std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "aggressive_flight.yaml";
  const Trajectory flight = body_trajectory(load_scenario(path, {}, std::nullopt));
  ASSERT_GE(flight.end_ns(), kEnd_ns);
  std::vector<EndError> errors;
  for (const double rate_hz : {100.0, 200.0, 400.0, 800.0}) errors.push_back(reintegrate(flight, rate_hz));
  // Least-squares slope of log2(error) over the octaves -1.5, -0.5, 0.5, 1.5.
  const auto log_error = [&](std::size_t i) { return std::log2(errors[i].position_m); };
  const double slope = (1.5 * (log_error(0) - log_error(3)) + 0.5 * (log_error(1) - log_error(2))) / 5.0;
  RecordProperty("slope", std::to_string(slope));
  RecordProperty("position_800hz_m", std::to_string(errors[3].position_m));
  RecordProperty("attitude_800hz_deg", std::to_string(errors[3].attitude_rad * 180.0 / M_PI));
  EXPECT_GE(slope, 1.9);
  // What a perfect 800 Hz unit may leave after a minute: far below any estimator's drift.
  EXPECT_LE(errors[3].position_m, 0.02);
  EXPECT_LE(errors[3].attitude_rad, 0.02 * M_PI / 180.0);
}

}  // namespace
}  // namespace plumbline
