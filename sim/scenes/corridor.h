#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// An office corridor that turns left and right by turns: legs of equal length, with L = length_m / (turns + 1), along
/// +x, +y, +x, ... The centre line runs from (0, 0) over the corners (L, 0), (L, L), (2L, L), ... and ends at a wall.
/// Whatever the seed, nothing reaches more than 0.25 m into the corridor from its walls, nor lower than 2.3 m.
SceneInfo corridor_scene();

}  // namespace plumbline
