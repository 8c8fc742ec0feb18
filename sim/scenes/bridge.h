#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A stone bridge of three arches along x over a river that runs along y; its road is at z = 0, the river's bed at
/// -valley_depth_m. Whatever the seed, the routes are free for 1 m around. Routes: `flight`, closed: along the river,
/// under the middle arch, round, and back under the arch at x = 24; `crossing`, along the road on the bridge.
SceneInfo bridge_scene();

}  // namespace plumbline
