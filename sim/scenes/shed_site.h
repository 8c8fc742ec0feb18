#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// Two sheds that are open at both ends, along x, on open ground, the second 70 m behind the first; and a double line
/// of trees along x, 46 m to their left, under whose crowns one can fly. Whatever the seed, the routes are free for 1 m
/// around. Routes: `walk` (672 m, closed, around and through the sheds), `shed_mission` (390 m flight that starts and
/// lands in the first shed and goes through the second), `tree_mission` (1,118 m flight: out at 20 m above the ground,
/// back at 2 m beneath the trees), `drive` (1,463 m, closed, along the trees).
SceneInfo shed_site_scene();

}  // namespace plumbline
