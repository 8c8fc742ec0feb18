#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// Level ground and one smooth wall along x, to the right of a route along y = 0. Both go on for more than a lidar's
/// 100 m beyond the route's ends, so that nothing tells it how far along it is.
SceneInfo ground_and_wall_scene();

}  // namespace plumbline
