#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A motorway of two lanes each way from (0, 0) along +x: wide, gently curved, with crash barriers, marker posts, sign
/// gantries, lamp posts and little else. Its lanes are free whatever the seed. Routes: `tour`, the right one of the
/// right-hand lanes; `fast`, the left one. Traffic keeps to the other carriageway.
SceneInfo highway_scene();

}  // namespace plumbline
