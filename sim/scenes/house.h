#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A house of four levels (basement, first, second and third floor, each with a hall and six furnished rooms) about the
/// origin, in its garden on an overcast evening with its lamps lit. The first route leads from the basement through
/// rooms of every floor to the third and back, the second is a loop on the first floor, the third one around the house.
SceneInfo house_scene();

}  // namespace plumbline
