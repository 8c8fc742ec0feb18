#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// Rows of fruit trees along x on grass, 5 m apart, centred at the origin. Whatever the seed, the alleys are free for
/// 1 m to either side of their middles. Route: `tour`, closed: up the alley at y = 0 and back along the one at y = 5.
SceneInfo orchard_scene();

}  // namespace plumbline
