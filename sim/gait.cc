#include "sim/gait.h"

#include <algorithm>
#include <cmath>

#include "sim/constants.h"

namespace plumbline {
namespace {

/// Height from a heel that struck `since_s` ago, of peak acceleration 1 [m/s^2]: a damped swing of the trunk,
/// pushed up first. Its onset is soft enough to be twice differentiable.
double strike(double since_s) {
  constexpr double kSwing_hz = 14.0;
  constexpr double kDamping_s = 0.04;
  constexpr double kOnset_s = 0.006;
  constexpr double kRate = 2.0 * M_PI * kSwing_hz;
  const double onset = 1.0 - std::exp(-since_s / kOnset_s);
  return std::sin(kRate * since_s) * std::exp(-since_s / kDamping_s) * onset * onset / (kRate * kRate);
}

double smooth_step(double x) {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

}  // namespace

WalkingGait::WalkingGait(const MotionConfig& config, std::uint64_t seed)
    : config_(config), stream_(seed, "gait"), unevenness_(stream_, 0.05, 0.4), phase_(stream_.uniform(0.0, 2.0)) {}

StepMotion WalkingGait::at(double time_s, double effort) const {
  constexpr double kUnevenness = 0.08;  // of a step
  constexpr double kSurge = 0.4;        // ahead and back, of the bob
  const double steps = config_.gait_frequency_hz * time_s + phase_ + kUnevenness * unevenness_.at(time_s);
  const double since_strike_s = (steps - std::floor(steps)) / std::max(config_.gait_frequency_hz, 0.1);
  const double step = 2.0 * M_PI * steps;
  StepMotion motion;
  // Lowest just after the strike, when both feet are on the ground.
  motion.offset = {kSurge * config_.gait_height_m * std::sin(step), config_.gait_sway_m * std::sin(0.5 * step),
                   -config_.gait_height_m * std::cos(step - 0.6) + config_.gait_impact_mps2 * strike(since_strike_s)};
  motion.tilt = Eigen::Vector3d(config_.gait_roll_deg * std::cos(0.5 * step), config_.gait_pitch_deg * std::cos(step),
                                config_.gait_roll_deg * std::sin(0.5 * step)) *
                kDegree;
  motion.offset *= effort;
  motion.tilt *= effort;
  return motion;
}

RunningGait::RunningGait(const MotionConfig& config, std::uint64_t seed) : config_(config), stream_(seed, "gait") {
  step_ = next_after({});
  step_ = next_after(step_);
}

RunningGait::Step RunningGait::next_after(const Step& step) {
  constexpr double kContactShare = 0.65;   // of an ordinary step
  constexpr double kJumpContact_s = 0.42;  // both the crouch before and the landing after are long
  Step next;
  next.start_s = step.end_s();
  next.landing_mps = step.takeoff_mps;  // what goes up comes down as fast
  const double period_s = stream_.uniform(0.97, 1.03) / config_.gait_frequency_hz;
  const bool jump = config_.gait_jump_m > 0.0 && until_jump_-- <= 0;
  if (jump) until_jump_ = stream_.integer(6, 10);
  next.takeoff_mps =
      jump ? std::sqrt(2.0 * kGravity * config_.gait_jump_m) : 0.5 * kGravity * (1.0 - kContactShare) * period_s;
  next.flight_s = 2.0 * next.takeoff_mps / kGravity;
  const bool after_jump = next.landing_mps > 1.3 * next.takeoff_mps;
  next.contact_s = jump || after_jump ? kJumpContact_s : kContactShare * period_s;
  ++number_;
  return next;
}

double RunningGait::height(const Step& step, double time_s) {
  const double t = time_s - step.start_s;
  if (t >= step.contact_s) {
    const double flown = t - step.contact_s;
    return step.takeoff_mps * flown - 0.5 * kGravity * flown * flown;
  }
  // Half a sine turns the fall into the take-off; a whole one beside it lets the contact end at the height at which it
  // began.
  const double contact = step.contact_s;
  const double u = t / contact;
  const double half = 0.5 * M_PI * (kGravity + (step.takeoff_mps + step.landing_mps) / contact);
  const double whole = -M_PI * (step.takeoff_mps - step.landing_mps) / contact;
  const double scale = contact * contact / M_PI;
  return -step.landing_mps * t - 0.5 * kGravity * t * t + half * scale * (u - std::sin(M_PI * u) / M_PI) +
         0.5 * whole * scale * (u - std::sin(2.0 * M_PI * u) / (2.0 * M_PI));
}

StepMotion RunningGait::at(double time_s, double effort) {
  while (time_s >= step_.end_s()) step_ = next_after(step_);
  // Whoever runs at all leaves the ground.
  const double share = smooth_step(effort / 0.6);
  // From side to side once a step, still at each footfall: steps of different lengths join smoothly.
  const double side = M_PI * (number_ + smooth_step((time_s - step_.start_s) / (step_.end_s() - step_.start_s)));
  StepMotion motion;
  motion.offset = {0.0, config_.gait_sway_m * std::sin(side),
                   height(step_, time_s) + config_.gait_impact_mps2 * strike(time_s - step_.start_s)};
  motion.tilt = Eigen::Vector3d(config_.gait_roll_deg * std::cos(side), config_.gait_pitch_deg * std::cos(2.0 * side),
                                config_.gait_roll_deg * std::sin(side)) *
                kDegree;
  motion.offset *= share;
  motion.tilt *= share;
  return motion;
}

}  // namespace plumbline
