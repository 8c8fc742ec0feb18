#pragma once

#include <cstdint>

#include "estimator/imu/mechanization.h"
#include "sim/trajectory.h"

namespace plumbline::testing {

/// What a perfect mechanisation would hold at a time: the true motion, no biases.
inline NavigationState true_state(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const MotionState truth = trajectory.at(stamp_ns);
  NavigationState state;
  state.stamp_ns = stamp_ns;
  state.world_from_body = truth.world_from_body;
  state.velocity_in_world = truth.velocity_in_world;
  return state;
}

}  // namespace plumbline::testing
