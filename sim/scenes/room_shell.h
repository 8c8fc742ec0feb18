#pragma once

#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/walls.h"

namespace plumbline {

/// A closed rectangular room about the origin.
struct RoomShell {
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();
  double height_m = 3.0;
  std::vector<std::string> floors;  ///< names of materials, at least two of each
  std::vector<std::string> walls;
  double door_along_m = -1.0;  ///< middle of a closed door in the wall at +y, along it; negative: none
};

/// Walls, floor, ceiling and door. Returns the walls in the order of rectangle_walls().
std::vector<Wall> add_room_shell(MjcfWriter& writer, RandomStream& stream, const RoomShell& shell);

/// Lamps in their housings below the ceiling, in rows at about `spacing_m`, of about `intensity_cd` each.
void add_ceiling_lamps(MjcfWriter& writer, RandomStream& stream, const RoomShell& shell, double spacing_m,
                       double intensity_cd);

}  // namespace plumbline
