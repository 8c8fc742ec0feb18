#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A flat lawn around the origin with nothing on it but short grass within clear_m of the middle. Beyond, houses, trees
/// and hedges on three sides; towards +x the land is open. Route: `tour`, 86 m, closed, within 15 m of the middle.
SceneInfo lawn_scene();

}  // namespace plumbline
