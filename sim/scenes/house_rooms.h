#pragma once

#include "sim/scenes/house_plan.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// What stands and hangs in the rooms and the hall of a level, out of the way of doors, and its lamps: stores and a
/// workshop in the basement, living rooms and a kitchen on the first floor, bedrooms and studies above.
void furnish_level(MjcfWriter& writer, const HousePlan& plan, int level);

}  // namespace plumbline
