#include "sim/vehicles/carried.h"

#include <algorithm>
#include <cmath>

#include "sim/band_limiter.h"
#include "sim/course.h"
#include "sim/gait.h"
#include "sim/hand.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

/// The even motion under all steps, as a spline; effort beside it.
struct Base {
  Trajectory trajectory;
  std::vector<double> effort;

  double effort_at(double time_s) const {
    const double place = std::clamp(time_s / Course::kStep_s, 0.0, static_cast<double>(effort.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(place), effort.size() - 2);
    const double u = place - static_cast<double>(i);
    return (1.0 - u) * effort[i] + u * effort[i + 1];
  }
};

Base base_of(const MotionConfig& config, const World& world) {
  const Course course = course_of(config, world);
  std::vector<PoseTrack::Stamped> poses;
  for (std::size_t i = 0; i < course.position.size(); ++i) {
    poses.push_back({static_cast<std::int64_t>(i) * static_cast<std::int64_t>(Course::kStep_s * 1e9),
                     {rotation_from_rpy({0.0, 0.0, course.yaw[i]}), course.position[i]}});
  }
  return {Trajectory(poses), course.effort};
}

/// How strongly a hand spins: fully while it is carried along, not at all at rest.
std::vector<double> spin_shares(const Base& base) {
  static_assert(HandSpin::kStep_s == Course::kStep_s);
  std::vector<double> shares;
  for (const double effort : base.effort) {
    const double u = std::clamp(effort / 0.2, 0.0, 1.0);
    shares.push_back(u * u * u * (10.0 + u * (6.0 * u - 15.0)));
  }
  return shares;
}

template <typename Steps>
Trajectory carry(const MotionConfig& config, const World& world, std::uint64_t seed, Steps steps) {
  constexpr double kStep_s = BandLimiter::kStep_s;
  constexpr double kStill = 0.2;  // of a hand's unrest that is left to who stands
  const Base base = base_of(config, world);
  const HandWander wander(config.hand_wander_deg, seed);
  HandSpin spin(config, spin_shares(base), seed);
  BandLimiter motion(-BandLimiter::kLead_ns);
  for (std::int64_t ns = -BandLimiter::kLead_ns; ns <= base.trajectory.end_ns(); ns += BandLimiter::kStep_ns) {
    const double time_s = 1e-9 * static_cast<double>(ns);
    const double effort = base.effort_at(time_s);
    const StepMotion step = steps.at(time_s, effort);
    spin.advance(time_s, kStep_s);
    const Pose even = base.trajectory.pose(ns);
    motion.add(even * Pose{rotation_from_rpy(step.tilt), step.offset} *
               wander.at(time_s, kStill + (1.0 - kStill) * effort) * spin.pose());
  }
  return motion.finish();
}

Trajectory walk(const MotionConfig& config, const World& world, const RayScene& /*rays*/, std::uint64_t seed) {
  return carry(config, world, seed, WalkingGait(config, seed));
}

Trajectory run(const MotionConfig& config, const World& world, const RayScene& /*rays*/, std::uint64_t seed) {
  if (config.gait_frequency_hz <= 0.0) throw std::invalid_argument("motion: gait.frequency_hz: a runner needs steps");
  return carry(config, world, seed, RunningGait(config, seed));
}

/// Who carries the pack in front of the chest: the pack sees trunk, shoulders, head and arms behind it.
SceneDescription person() {
  MjcfWriter writer;
  writer.capsule("panels_blue", {-0.38, 0.0, -0.45}, {-0.36, 0.0, -0.08}, 0.17);
  writer.capsule("panels_blue", {-0.36, -0.2, -0.04}, {-0.36, 0.2, -0.04}, 0.07);
  writer.ellipsoid("plaster", {-0.34, 0.0, 0.22}, {0.1, 0.08, 0.13});
  for (const double y : {-0.25, 0.25}) {
    writer.capsule("panels_blue", {-0.34, y, -0.06}, {-0.28, 1.1 * y, -0.32}, 0.05);
    writer.capsule("panels_blue", {-0.28, 1.1 * y, -0.32}, {-0.04, 0.5 * y, -0.12}, 0.04);
  }
  return writer.finish("person", scene_palette(), 30.0, 0.0);
}

MotionConfig walking_defaults() {
  MotionConfig defaults;
  defaults.vehicle = "walker";
  defaults.height_m = 1.4;
  defaults.speed_mps = 1.4;
  defaults.lateral_acceleration_mps2 = 1.0;
  defaults.gait_frequency_hz = 1.9;
  defaults.gait_height_m = 0.025;
  defaults.gait_sway_m = 0.02;
  defaults.gait_roll_deg = 1.2;
  defaults.gait_pitch_deg = 1.0;
  defaults.gait_impact_mps2 = 2.5;
  defaults.hand_wander_deg = 1.0;
  return defaults;
}

MotionConfig running_defaults() {
  MotionConfig defaults = walking_defaults();
  defaults.vehicle = "runner";
  defaults.speed_mps = 3.2;
  defaults.acceleration_mps2 = 1.5;
  defaults.lateral_acceleration_mps2 = 2.0;
  defaults.gait_frequency_hz = 2.7;
  defaults.gait_roll_deg = 2.5;
  defaults.gait_pitch_deg = 2.5;
  defaults.gait_impact_mps2 = 8.0;
  defaults.gait_jump_m = 0.3;
  defaults.hand_wander_deg = 2.0;
  return defaults;
}

MotionConfig hand_defaults() {
  MotionConfig defaults = walking_defaults();
  defaults.vehicle = "hand";
  defaults.speed_mps = 0.6;
  defaults.gait_frequency_hz = 1.4;
  defaults.gait_height_m = 0.015;
  defaults.gait_impact_mps2 = 1.0;
  defaults.hand_wander_deg = 3.0;
  defaults.spin_mean_dps = 83.0;
  defaults.spin_peak_dps = 370.0;
  return defaults;
}

}  // namespace

VehicleInfo walker_vehicle() {
  return {.name = "walker",
          .summary = "person who walks with the pack held before the chest: bob, sway, heel strikes, unsteady hands",
          .defaults = walking_defaults(),
          .drive = walk,
          .body = person};
}

VehicleInfo runner_vehicle() {
  return {.name = "runner",
          .summary = "person who runs and jumps: free fall between the steps, hard landings",
          .defaults = running_defaults(),
          .drive = run,
          .body = person};
}

VehicleInfo hand_vehicle() {
  return {.name = "hand",
          .summary = "hand that spins and shakes the pack about all axes, 83 deg/s on average, 370 deg/s at most",
          .defaults = hand_defaults(),
          .drive = walk,
          .body = nullptr};
}

}  // namespace plumbline
