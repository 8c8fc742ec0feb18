#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A narrow lane between trees, hedges, bushes and high grass: clutter that a lidar half sees through. Whatever the
/// seed, 1.5 m to either side of its middle are free up to 2.3 m. Route: `tour`, along the middle.
SceneInfo vegetated_road_scene();

}  // namespace plumbline
