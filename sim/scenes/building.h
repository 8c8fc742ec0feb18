#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// An office building about the origin on its grounds. The first route leads around it, way_m from its walls; the
/// second takes off there, flies to and fro over the roof, and lands where it started.
SceneInfo building_scene();

}  // namespace plumbline
