#pragma once

#include "scenarios/session.h"

namespace plumbline {

/// The body's motion in a scenario, for tests that need nothing else of its world.
inline Trajectory body_trajectory(const Scenario& scenario) {
  const World world = make_world(scenario);
  return make_body_trajectory(scenario, world, RayScene(world));
}

}  // namespace plumbline
