#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// The inside of a sphere about the origin. All a lidar can tell is where the middle is: turning about it changes
/// nothing. A camera sees the pattern, unless `patterned` is 0.
SceneInfo sphere_scene();

}  // namespace plumbline
