#pragma once

#include <cstdint>

#include "sim/scenes/outdoors.h"
#include "sim/scenes/street_plan.h"

namespace plumbline {

/// What a street's stretches of each district are made of. Everything keeps off the lanes (|n| < 3.5 m, up to 4.5 m
/// above them), and comes from a stream of its own along s, so that a longer street begins as a shorter one does.

/// Houses, halls, farms, and what is in their gardens and yards.
void add_plots(Scenery& scenery, const StreetPlan& plan, std::uint64_t seed);

/// Parked cars where a kerb is, in parking_share of the places.
void add_parked_cars(Scenery& scenery, const StreetPlan& plan, double parking_share, std::uint64_t seed);

/// Lamps, signs, poles, things on pavements, marker posts, guard rails.
void add_furniture(Outdoors& outdoors, const StreetPlan& plan, std::uint64_t seed);

/// Trees along the road and in the woods, bushes, grass.
void add_greenery(Scenery& scenery, const StreetPlan& plan, double leaf_density, std::uint64_t seed);

/// Bridges that carry the road over valleys with a river, and others across the road.
void add_bridges(Scenery& scenery, const StreetPlan& plan, std::uint64_t seed);

}  // namespace plumbline
