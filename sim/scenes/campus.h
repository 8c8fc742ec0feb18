#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A closed walk and cycle path among the buildings, lawns and trees of a campus. Whatever the seed, the path is free:
/// 2 m to either side of its middle, up to 2.4 m. Route: `tour`, once round, closed.
SceneInfo campus_scene();

}  // namespace plumbline
