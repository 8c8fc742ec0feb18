#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A closed, furnished room about the origin that is almost dark unless a scenario sets a light level. A lidar finds
/// as much in it as in any other room.
SceneInfo dark_room_scene();

}  // namespace plumbline
