#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A corridor with turns whose legs look different: ordinary, striped upright, blank, ordinary, striped level, blank,
/// ordinary. Within a striped leg every surface but the stripes is blank, so that a camera sees edges of one direction:
/// upright stripes leave its height unseen, level ones where along the wall it is. The shape is the same everywhere.
SceneInfo striped_walls_scene();

}  // namespace plumbline
