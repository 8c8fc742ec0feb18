#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// A hole in a wall: a door's from the floor up, a window's from its sill.
struct Opening {
  double begin_m = 0.0;  ///< along the wall
  double end_m = 0.0;
  double height_m = 0.0;  ///< of its upper edge above the floor
  double sill_m = 0.0;    ///< of its lower edge
};

/// A straight wall. The room lies to the left of from -> to, its thickness to the right: rooms go anticlockwise.
struct Wall {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double height_m = 3.0;
  double thickness_m = 0.2;
  std::vector<Opening> openings = {};  ///< apart from each other, in order along the wall
  double section_m = 6.0;              ///< a stretch of one material is at most this long
  double floor_m = 0.0;                ///< height of the floor in the world
};

/// The four walls of a rectangular room about the origin: at -y, +x, +y and -x. Those along x close the corners.
std::vector<Wall> rectangle_walls(const Eigen::Vector2d& half_size, double height_m);

/// The wall's frame: origin at `from` on the floor, x along the wall, y into the room.
Pose frame_of(const Wall& wall);

/// Sections of differing materials, exactly flush.
void add_wall(MjcfWriter& writer, const Wall& wall, const std::vector<std::string>& materials, RandomStream& stream);

/// A frame around an opening, 3 cm proud of both faces and 5 cm narrower than the hole on each side. A window's has a
/// sill and a cross of bars, too.
void add_door_frame(MjcfWriter& writer, const Wall& wall, const Opening& opening);
void add_window_frame(MjcfWriter& writer, const Wall& wall, const Opening& opening);

/// A flat thing on a wall's face, `depth_m` deep: a board, a cabinet, a radiator.
struct Fixture {
  std::string material;
  double along_m = 0.0;   ///< of its middle
  double height_m = 0.0;  ///< of its middle
  double width_m = 0.0;
  double tall_m = 0.0;
  double depth_m = 0.02;
};
void add_fixture(MjcfWriter& writer, const Pose& world_from_wall, const Fixture& fixture);

/// Where to cut [from, to] into stretches of random lengths between shortest and longest; both ends included.
/// Whole centimetres inside, so that neighbours written to the file stay exactly flush.
std::vector<double> random_cuts(RandomStream& stream, double from, double to, double shortest, double longest);

}  // namespace plumbline
