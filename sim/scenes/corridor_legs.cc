#include "sim/scenes/corridor_legs.h"

#include <cmath>

#include "sim/scenes/routes.h"

namespace plumbline {
namespace {

Wall wall_between(const Leg& leg, const Eigen::Vector3d& from_in_leg, const Eigen::Vector3d& to_in_leg) {
  const Eigen::Vector3d from = leg.world_from_leg * from_in_leg;
  const Eigen::Vector3d to = leg.world_from_leg * to_in_leg;
  Wall wall;
  wall.from = from.head<2>();
  wall.to = to.head<2>();
  wall.height_m = leg.height;
  wall.thickness_m = Leg::kWallM;
  wall.section_m = 5.0;
  return wall;
}

}  // namespace

std::vector<Leg> make_legs(const std::string& scene, const std::vector<double>& lengths, double width, double height) {
  std::vector<Leg> legs;
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const bool along_x = i % 2 == 0;
    Leg leg;
    leg.world_from_leg = upright_frame(corner, along_x ? 0.0 : M_PI / 2.0);
    leg.length = lengths[i];
    leg.half_width = width / 2.0;
    leg.height = height;
    leg.turn_before = i == 0 ? 0 : (along_x ? Leg::kRight : Leg::kLeft);
    leg.turn_after = i + 1 == lengths.size() ? 0 : (along_x ? Leg::kLeft : Leg::kRight);
    leg.name = scene + "/leg" + std::to_string(i);
    legs.push_back(leg);
    corner = leg.world_from_leg * Eigen::Vector3d(leg.length, 0.0, 0.0);
  }
  return legs;
}

// Outer walls run past their ends by their own thickness, so that no light gets through the corners. At an inner corner
// the second leg's wall begins behind the first one's, so that no two faces coincide.
Wall side_wall(const Leg& leg, int side) {
  const double y = side * leg.half_width;
  const double begin = leg.wall_begin(side) + (side * leg.turn_before == 1 ? Leg::kWallM : -Leg::kWallM);
  const double end = leg.wall_end(side) + (side * leg.turn_after == 1 ? 0.0 : Leg::kWallM);
  return side == Leg::kRight ? wall_between(leg, {begin, y, 0.0}, {end, y, 0.0})
                             : wall_between(leg, {end, y, 0.0}, {begin, y, 0.0});
}

Wall first_wall(const Leg& first) {
  return wall_between(first, {0.0, first.half_width, 0.0}, {0.0, -first.half_width, 0.0});
}

Wall last_wall(const Leg& last) {
  return wall_between(last, {last.length, -last.half_width, 0.0}, {last.length, last.half_width, 0.0});
}

Route centre_line(const std::string& name, const std::vector<Leg>& legs) {
  constexpr double kClearOfEndsM = 1.5;
  std::vector<Eigen::Vector3d> corners{legs.front().world_from_leg * Eigen::Vector3d(kClearOfEndsM, 0.0, 0.0)};
  for (const Leg& leg : legs) {
    const double end = leg.turn_after == 0 ? leg.length - kClearOfEndsM : leg.length;
    corners.push_back(leg.world_from_leg * Eigen::Vector3d(end, 0.0, 0.0));
  }
  return make_route(name, corners, 1.5);
}

}  // namespace plumbline
