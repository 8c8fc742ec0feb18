#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// An underground garage: halls in a row along +x, separated by solid walls with a door opening each.
///
/// With L = hall_length_m, hall i reaches from x_i = i (L + 0.2) to x_i + L, and from y = -hall_width_m/2 to
/// +hall_width_m/2. Whatever the seed and the clutter, these stay free, from the floor up to 2.4 m:
///   - two lanes along each hall: centre lines y = +4.75 and y = -4.75, 1.8 m to either side;
///   - two cross lanes in each hall: centre lines x = x_i + 3.5 and x = x_i + L - 3.5, 1.8 m to either side, |y|
///   <= 6.5;
///   - the door from hall i to i + 1, 2.9 m wide: at y = -4.75 for even i, at y = +4.75 for odd i. Every other door
///   stands
///     on the other side, so that nobody looks through two of them.
/// Things are parked in the bays only: along both long walls, and on the island between the lanes.
SceneInfo garage_scene();

}  // namespace plumbline
