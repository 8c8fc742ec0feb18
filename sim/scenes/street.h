#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A winding street from (0, 0) along +x through town, suburbs, works, fields and woods, over hills, with bridges over
/// valleys and others across it. Its two lanes are free whatever the seed: 3.5 m to either side of its middle, from the
/// road up to 4.5 m. Routes: `tour`, the right lane; `back`, the other one. Moving cars keep to the left lane.
SceneInfo street_scene();

}  // namespace plumbline
