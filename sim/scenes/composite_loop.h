#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A walk of 538 m by night through what fails one sensor after the other, and back to its start (test 3 of the
/// thesis's chapter 7): a corridor whose middle is dark; stairs down to a hilly trail through woods; level ground with
/// nothing but one smooth wall to the right; unlit woods; level ground with nothing at all within 30 m; stairs up to
/// the corridor. Lamps shine everywhere else. The first route, `loop`, is closed and starts in the corridor.
SceneInfo composite_loop_scene();

}  // namespace plumbline
