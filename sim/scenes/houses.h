#pragma once

#include <string>

#include "sim/random_stream.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

enum class Roof { kGableAlong, kGableAcross, kFlat };

/// A building with windows, doors and all that stands out of its walls. Its frame: the origin on the ground under the
/// middle of its front, x along the front to the right of someone who looks out of it (that is, the front looks along
/// -y), z up. It fills |x| <= width / 2, 0 <= y <= depth; steps, balconies and awnings stand up to 1.3 m before it.
struct House {
  double width_m = 12.0;
  double depth_m = 10.0;
  int floors = 3;
  double floor_m = 3.0;
  Roof roof = Roof::kGableAlong;
  std::string wall = "plaster_cream";
  std::string roofing = "roof_tiles";
  bool shop = false;       ///< a shop's front on the ground floor
  bool balconies = false;  ///< before some windows of the upper floors
  bool side_windows = true;
};

/// A town house for a row, or a block of flats.
House draw_town_house(RandomStream& stream, double width_m);
/// A detached house with a garden.
House draw_villa(RandomStream& stream);

void add_house(Scenery& scenery, RandomStream& stream, const Pose& world_from_house, const House& house);

/// A shed, barn or works hall of profiled metal: gates, bands of windows, a low roof.
struct Hall {
  double width_m = 30.0;
  double depth_m = 20.0;
  double eaves_m = 6.0;
  std::string wall = "cladding_grey";
};
void add_hall_building(Scenery& scenery, RandomStream& stream, const Pose& world_from_hall, const Hall& hall);

}  // namespace plumbline
