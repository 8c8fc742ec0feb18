#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A large hall for flying: columns and racks along the walls, crates on the floor, panels and boards on the walls.
/// It is centred at the origin: |x| <= length_m / 2, |y| <= width_m / 2. Whatever the seed and the clutter, the volume
/// |x| <= length_m / 2 - 4, |y| <= width_m / 2 - 4, 2.2 <= z <= height_m - 2 is free.
SceneInfo hall_scene();

}  // namespace plumbline
