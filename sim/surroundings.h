#pragma once

#include "estimator/geometry/pose.h"
#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {

/// The vehicle that carries the sensors, as they see it: rigid, in its own frame.
struct OwnBody {
  World world;    ///< the vehicle's geoms and materials, in the vehicle's frame
  RayScene rays;  ///< of `world`
  Pose body_from_vehicle;
};

/// What a sensor on the rig can meet.
struct Surroundings {
  const World& world;
  const RayScene& rays;
  const OwnBody* own_body = nullptr;  ///< nullptr: none, or left out
};

}  // namespace plumbline
