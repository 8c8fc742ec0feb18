#pragma once

#include <string>

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

/// A parked car, van or estate: its frame stands on the ground under its middle, x towards its nose. None is longer
/// than 5.2 m, wider than 2.0 m or higher than 2.3 m.
void add_parked_car(Scenery& scenery, RandomStream& stream, const Pose& world_from_car);

/// The geoms of a moving car or van about its body's origin, which is on the ground under its middle, x forward.
void add_moving_car(MjcfWriter& writer, RandomStream& stream, const std::string& body_name);

}  // namespace plumbline
