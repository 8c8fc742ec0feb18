#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A closed hall about the origin: a glass front at -y, two rows of columns, a reception at +x, seats at -x, and at +y
/// stairs up to a gallery. The first route leads around between the columns.
SceneInfo lobby_scene();

}  // namespace plumbline
