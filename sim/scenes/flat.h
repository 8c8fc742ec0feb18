#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// Level, textured ground about the origin, 300 m to every side, under a clear sky, and landmarks no nearer to the
/// origin than landmark_distance_m.
SceneInfo flat_scene();

}  // namespace plumbline
