#include "sim/motion.h"
#include "sim/constants.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "sim/band_limiter.h"
#include "sim/path.h"
#include "tests/sim/vehicle_world.h"

namespace plumbline {
namespace {

using testing::by_vehicle;
using testing::duration_s;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using testing::vehicle_world;

Trajectory carried(const MotionConfig& config, const World& world) {
  return make_trajectory(config, world, RayScene(world), 1);
}

/// Amplitude of vertical acceleration at a frequency.
double line_at(const Trajectory& motion, double hz, double from_s, double to_s) {
  std::complex<double> sum;
  int count = 0;
  for (double t = from_s; t < to_s; t += 0.005, ++count) {
    sum += motion.at_seconds(t).acceleration_in_world.z() * std::polar(1.0, -2.0 * M_PI * hz * t);
  }
  return 2.0 * std::abs(sum) / count;
}

TEST(Path, RoundsACornerAndKeepsItsEnds) {
  const std::vector<Eigen::Vector3d> corner{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {20, 10, 0}, {20, 20, 0}};
  const Path path(corner, 6.0);
  EXPECT_LT((path.at(0.0).position - corner.front()).norm(), 1e-6);
  EXPECT_LT((path.at(path.length_m()).position - corner.back()).norm(), 1e-6);
  double tightest = 0.0;
  for (double s = 0.0; s < path.length_m(); s += 0.05) {
    EXPECT_NEAR(path.at(s).tangent.norm(), 1.0, 0.01) << s;
    tightest = std::max(tightest, path.at(s).turn());
  }
  EXPECT_GT(tightest, 0.1);
  EXPECT_LT(tightest, 1.0);
  EXPECT_NEAR(path.nearest({15.0, 0.3, 0.0}, 14.0), 15.0, 0.2);
}

TEST(Routes, PartsAreFollowedFromStartForTheirLength) {
  const World world = vehicle_world();
  MotionConfig config;
  config.route = "straight";
  config.route_start_m = 100.0;
  config.route_length_m = 30.0;
  config.height_m = 1.5;
  const Trajectory motion = carried(config, world);
  EXPECT_LT((motion.pose(0).translation - Eigen::Vector3d(100.0, 0.0, 1.5)).norm(), 1e-6);
  EXPECT_LT((motion.pose(motion.end_ns()).translation - Eigen::Vector3d(130.0, 0.0, 1.5)).norm(), 1e-6);
}

TEST(Routes, ClosedOnesLeadBackToTheirStartAndOn) {
  const World world = vehicle_world();
  MotionConfig config;
  config.route = "oval";
  const Trajectory round = carried(config, world);
  EXPECT_LT((round.pose(0).translation - round.pose(round.end_ns()).translation).norm(), 1e-6);
  config.route_length_m = 400.0;  // the oval is 207 m round
  EXPECT_GT(carried(config, world).end_ns(), round.end_ns());
}

TEST(Routes, SlowDownForCurves) {
  const World world = vehicle_world();
  MotionConfig config;
  config.route = "oval";
  config.speed_mps = 12.0;
  config.acceleration_mps2 = 3.0;
  config.lateral_acceleration_mps2 = 2.0;
  const Trajectory motion = carried(config, world);
  double across = 0.0;
  for (double t = 0.0; t < duration_s(motion); t += 0.02) {
    const MotionState s = motion.at_seconds(t);
    const Eigen::Vector3d left = s.world_from_body.rotation * Eigen::Vector3d::UnitY();
    across = std::max(across, std::abs(left.dot(s.acceleration_in_world)));
  }
  EXPECT_LT(across, 2.2);  // changes of speed are spread over smoothing_s, which reaches into the curve
  EXPECT_GT(across, 1.6);
}

TEST(Routes, SayWhatIsWrong) {
  const World world = vehicle_world();
  MotionConfig config;
  config.route = "strait";
  EXPECT_THAT([&] { carried(config, world); },
              ThrowsMessage<std::invalid_argument>(::testing::AllOf(HasSubstr("strait"), HasSubstr("straight, oval"))));
  config.route = "straight";
  config.route_start_m = 800.0;
  EXPECT_THAT([&] { carried(config, world); }, ThrowsMessage<std::invalid_argument>(HasSubstr("route_start_m")));
  config.route_start_m = 600.0;
  config.route_length_m = 200.0;
  EXPECT_THAT([&] { carried(config, world); }, ThrowsMessage<std::invalid_argument>(HasSubstr("route_length_m")));
  config.vehicle = "sledge";
  EXPECT_THAT([&] { carried(config, world); }, ThrowsMessage<std::invalid_argument>(HasSubstr("walker, runner")));
}

TEST(Walker, BobsAtItsStepsAndStrikesWithItsHeels) {
  const World world = vehicle_world();
  MotionConfig config = by_vehicle("walker", "straight");
  config.route_length_m = 40.0;
  const Trajectory walk = carried(config, world);
  const double steps = std::max({line_at(walk, 1.88, 6, 26), line_at(walk, 1.9, 6, 26), line_at(walk, 1.92, 6, 26)});
  EXPECT_GT(steps, 1.5);  // a bob of 25 mm at 1.9 Hz is 3.6 m/s^2; uneven steps spread some of it
  EXPECT_LT(line_at(walk, 1.4, 6, 26), 0.2 * steps);
  double hardest = 0.0;
  double sideways = 0.0;
  for (double t = 6.0; t < 26.0; t += 0.005) {
    const MotionState s = walk.at_seconds(t);
    hardest = std::max(hardest, std::abs(s.acceleration_in_world.z()));
    sideways = std::max(sideways, std::abs(s.world_from_body.translation.y()));
    EXPECT_LT(s.angular_rate_in_body.norm(), 60.0 * kDegree);
  }
  EXPECT_GT(hardest, 4.0);  // what accelerometers on walking people show: 0.3 to 1 g beyond gravity
  EXPECT_LT(hardest, 10.0);
  EXPECT_LT(sideways, 0.1);
}

TEST(Runner, FallsFreelyBetweenStepsAndLandsHard) {
  const World world = vehicle_world();
  MotionConfig config = by_vehicle("runner", "straight");
  config.route_length_m = 60.0;
  const Trajectory run = carried(config, world);
  int falling = 0;
  int count = 0;
  double hardest = 0.0;
  double highest = 0.0;
  for (double t = 6.0; t < duration_s(run) - 6.0; t += 0.005, ++count) {
    const MotionState s = run.at_seconds(t);
    const double force = s.acceleration_in_world.z() + 9.81;
    falling += force < 2.0 ? 1 : 0;
    hardest = std::max(hardest, force);
    highest = std::max(highest, s.world_from_body.translation.z() - config.height_m);
  }
  EXPECT_GT(falling, count / 5);  // a third of an ordinary step is flight
  EXPECT_LT(falling, count / 2);
  EXPECT_GT(hardest, 2.0 * 9.81);  // runners' trunks see 2 to 5 g
  EXPECT_LT(hardest, 5.0 * 9.81);
  EXPECT_NEAR(highest, 0.3, 0.05);  // the jumps
}

TEST(Hand, SpinsWithTheMeanAndPeakAskedFor) {
  const World world = vehicle_world();
  for (const auto& [mean_dps, peak_dps] : {std::pair{83.0, 370.0}, std::pair{60.0, 250.0}}) {
    MotionConfig config = by_vehicle("hand", "straight");
    config.route_length_m = 47.0;
    config.gait_frequency_hz = 0.0;
    config.hand_wander_deg = 0.0;
    config.spin_mean_dps = mean_dps;
    config.spin_peak_dps = peak_dps;
    const Trajectory motion = carried(config, world);
    double sum = 0.0;
    double peak = 0.0;
    int count = 0;
    for (double t = 0.0; t < duration_s(motion); t += 0.005) {
      const double rate = motion.at_seconds(t).angular_rate_in_body.norm();
      peak = std::max(peak, rate);
      sum += rate;
      count += rate > 1e-4 ? 1 : 0;
    }
    EXPECT_NEAR(sum / count / kDegree, mean_dps, 0.05 * mean_dps);
    EXPECT_NEAR(peak / kDegree, peak_dps, 0.02 * peak_dps);
  }
}

TEST(BandLimiter, PassesWhatAMountPassesWithoutDelay) {
  const auto gain = [](double hz) {
    BandLimiter motion;
    for (int i = 0; i < 2000; ++i) {
      motion.add({Eigen::Quaterniond::Identity(), {std::sin(2.0 * M_PI * hz * i * BandLimiter::kStep_s), 0.0, 0.0}});
    }
    const Trajectory limited = motion.finish();
    double sum = 0.0;
    double squares = 0.0;
    for (std::int64_t ns = 500'000'000; ns < 1'500'000'000; ns += BandLimiter::kKnot_ns) {
      const double in = std::sin(2.0 * M_PI * hz * 1e-9 * static_cast<double>(ns));
      sum += limited.pose(ns).translation.x() * in;
      squares += in * in;
    }
    return sum / squares;
  };
  EXPECT_NEAR(gain(5.0), 1.0, 0.01);
  EXPECT_NEAR(gain(60.0 - 0.5), std::sqrt(0.5), 0.02);
  EXPECT_LT(gain(97.0), 0.45);
}

}  // namespace
}  // namespace plumbline
