#pragma once

#include <vector>

#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {

/// Strong lamps of short reach, each close in front of a surface beside the world's first route: patches that are lit
/// far beyond what a camera can hold together with their surroundings. They follow the world's seed.
/// @throws std::invalid_argument if the world has no route.
std::vector<Lamp> glare_lamps(const World& world, const RayScene& rays, int patches);

}  // namespace plumbline
