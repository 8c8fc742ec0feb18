#pragma once

#include "sim/scenes/garage_plan.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// The parking bays of one hall: markings, kerb, ramp, and what stands in them. More clutter fills more bays and leaves
/// what stood there before in place.
void add_bays(MjcfWriter& writer, const GaragePlan& plan, int hall);

}  // namespace plumbline
