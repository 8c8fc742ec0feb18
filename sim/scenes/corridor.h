#pragma once

#include <cstdint>

#include "sim/scene_library.h"
#include "sim/scenes/corridor_legs.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// A stretch of a leg, along it [m], without lamps.
struct Unlit {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// Walls with doors, boards, radiators and cabinets, floor, ceiling and lamps of one leg; its ends stay open.
void add_corridor_leg(MjcfWriter& writer, const Leg& leg, double door_spacing_m, std::uint64_t seed,
                      const Unlit& unlit = {});

/// An office corridor that turns left and right by turns: legs of equal length, with L = length_m / (turns + 1), along
/// +x, +y, +x, ... The centre line runs from (0, 0) over the corners (L, 0), (L, L), (2L, L), ... and ends at a wall.
/// Whatever the seed, nothing reaches more than 0.25 m into the corridor from its walls, nor lower than 2.3 m.
SceneInfo corridor_scene();

}  // namespace plumbline
