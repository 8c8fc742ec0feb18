#pragma once

#include <string>
#include <vector>

#include "sim/scenes/walls.h"
#include "sim/world.h"

namespace plumbline {

/// One straight leg of a corridor that turns left and right by turns, in a frame with its origin at the leg's first
/// corner and x along it.
struct Leg {
  static constexpr double kWallM = 0.2;
  static constexpr int kLeft = +1;
  static constexpr int kRight = -1;

  Pose world_from_leg;
  double length = 0.0;  ///< from corner to corner
  double half_width = 0.0;
  double height = 0.0;
  int turn_before = 0;  ///< kLeft, kRight, or 0: the corridor begins here
  int turn_after = 0;
  std::string name;  ///< of its random streams

  /// Where a side's wall begins and ends: the inner wall of a turn stops short of the corner, the outer one passes it.
  double wall_begin(int side) const { return turn_before == 0 ? 0.0 : side * turn_before * half_width; }
  double wall_end(int side) const { return turn_after == 0 ? length : length - side * turn_after * half_width; }

  /// The square of a corner belongs to the leg before it.
  double floor_begin() const { return turn_before == 0 ? -kWallM : half_width; }
  double floor_end() const { return length + (turn_after == 0 ? kWallM : half_width); }
  double floor_half_width() const { return half_width + (turn_before == 0 ? kWallM : 0.0); }
};

/// The first leg runs along x from the origin, the next one turns left.
std::vector<Leg> make_legs(const std::string& scene, const std::vector<double>& lengths, double width, double height);

/// A leg's left or right wall, and the walls that close the corridor.
Wall side_wall(const Leg& leg, int side);
Wall first_wall(const Leg& first);
Wall last_wall(const Leg& last);

/// From 1.5 m behind the first wall to 1.5 m before the last one.
Route centre_line(const std::string& name, const std::vector<Leg>& legs);

}  // namespace plumbline
