#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// One closed room about the origin, its table in the middle with a way of 0.9 m or more all around it.
SceneInfo conference_room_scene();

}  // namespace plumbline
