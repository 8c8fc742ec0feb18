#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A foot path through hilly woods with flights of stairs, from (0, 0) along +x. Whatever the seed, 1.2 m to either
/// side of its middle are free up to 2.3 m. Route: `tour`; on stairs its points are on the middles of the treads.
SceneInfo trail_scene();

}  // namespace plumbline
