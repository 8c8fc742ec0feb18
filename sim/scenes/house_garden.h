#pragma once

#include "sim/scenes/house_plan.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// Lawn with a path around the house, bushes, trees, a hedge around it all, lamps, and the neighbours' houses.
void add_garden(MjcfWriter& writer, const HousePlan& plan);

}  // namespace plumbline
