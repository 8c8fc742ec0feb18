#include "sim/scenes/house_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/scenes/routes.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlightWidth_m = 1.1;
constexpr double kTurnRadius_m = 0.4;
constexpr double kStairTurn_m = 0.7;  // y where ways from the doors turn to the stairs

double along_of(const HouseOpening& opening, const Wall& wall) {
  return (opening.middle - wall.from).dot((wall.to - wall.from).normalized());
}

void cut(Wall& wall, const std::vector<HouseOpening>& openings) {
  const double length = (wall.to - wall.from).norm();
  for (const HouseOpening& opening : openings) {
    if (!is_in_wall(opening, wall, 0.0, length, 0.0)) continue;
    const double along = along_of(opening, wall);
    wall.openings.push_back(
        {along - opening.width_m / 2.0, along + opening.width_m / 2.0, opening.top_m, opening.sill_m});
  }
  std::sort(wall.openings.begin(), wall.openings.end(),
            [](const Opening& a, const Opening& b) { return a.begin_m < b.begin_m; });
}

/// Corners of ways through the house, level by level.
class Ways {
 public:
  explicit Ways(const HousePlan& plan) : plan_(plan) {}

  void go(int level, double x, double y) { corners_.emplace_back(x, y, plan_.floor_of(level)); }
  /// A flight with the places before and behind it.
  void climb(int level) {
    for (const Vector3d& corner : flight_corners(level)) corners_.push_back(corner);
  }
  void descend(int level) {
    std::vector<Vector3d> corners = flight_corners(level - 1);
    std::reverse(corners.begin(), corners.end());
    corners_.insert(corners_.end(), corners.begin(), corners.end());
  }
  /// From the landing in the east through the rooms in the north (side 1) or south (-1) to the west of the hall.
  void through_rooms_west(int level, double side) {
    go(level, plan_.door_x(), kStairTurn_m);
    go(level, plan_.door_x(), side * plan_.row_y());
    go(level, -plan_.door_x(), side * plan_.row_y());
    go(level, -plan_.door_x(), kStairTurn_m);
  }
  void through_rooms_east(int level, double side) {
    go(level, -plan_.door_x(), kStairTurn_m);
    go(level, -plan_.door_x(), side * plan_.row_y());
    go(level, plan_.door_x(), side * plan_.row_y());
    go(level, plan_.door_x(), kStairTurn_m);
  }
  const std::vector<Vector3d>& corners() const { return corners_; }

 private:
  std::vector<Vector3d> flight_corners(int level) const {
    constexpr double kApproach_m = 0.8;
    const Flight flight = plan_.flight();
    const Vector3d foot = plan_.foot_of_flight(level);
    const Vector3d top = foot + Vector3d(flight.run_m(), 0.0, flight.rise_m);
    return {foot - Vector3d(kApproach_m, 0.0, 0.0), foot - Vector3d(flight.tread_m, 0.0, 0.0), top,
            top + Vector3d(kApproach_m, 0.0, 0.0)};
  }

  const HousePlan& plan_;
  std::vector<Vector3d> corners_;
};

Route all_floors(const HousePlan& plan) {
  Ways ways(plan);
  const auto basement_room = [&](bool out) {
    if (out) ways.go(0, 0.0, -plan.row_y());
    ways.go(0, -plan.door_x(), out ? -plan.row_y() : kStairTurn_m);
    ways.go(0, -plan.door_x(), out ? kStairTurn_m : -plan.row_y());
    if (!out) ways.go(0, 0.0, -plan.row_y());
  };
  basement_room(true);
  ways.climb(0);
  for (const int level : {1, 2}) {
    ways.through_rooms_west(level, 1.0);
    ways.climb(level);
  }
  // At the top first the rooms in the north, then those in the south.
  ways.go(3, plan.door_x(), kStairTurn_m);
  ways.go(3, plan.door_x(), plan.row_y());
  ways.go(3, -plan.door_x(), plan.row_y());
  ways.go(3, -plan.door_x(), -plan.row_y());
  ways.go(3, plan.door_x(), -plan.row_y());
  ways.go(3, plan.door_x(), kStairTurn_m);
  ways.descend(3);
  for (const int level : {2, 1}) {
    ways.through_rooms_east(level, -1.0);
    ways.descend(level);
  }
  basement_room(false);
  return make_route("all_floors", ways.corners(), kTurnRadius_m);
}

// East through the hall, back through the rooms in the north, across the hall, through those in the south, and back
// along the hall's other side.
Route first_floor(const HousePlan& plan) {
  constexpr double kEastward_m = 0.1;
  constexpr double kWestward_m = -1.2;
  const double west = -plan.half.x() + 1.2;
  const double x = plan.door_x();
  const double y = plan.row_y();
  Ways ways(plan);
  ways.go(1, 0.0, kEastward_m);
  ways.go(1, x, kEastward_m);
  ways.go(1, x, y);
  ways.go(1, -x, y);
  ways.go(1, -x, -y);
  ways.go(1, x, -y);
  ways.go(1, x, kWestward_m);
  ways.go(1, west, kWestward_m);
  ways.go(1, west, kEastward_m);
  return make_route("first_floor", ways.corners(), kTurnRadius_m, true);
}

}  // namespace

bool is_in_wall(const HouseOpening& opening, const Wall& wall, double begin_m, double end_m, double margin_m) {
  constexpr double kAcross_m = 0.3;
  const Vector2d along = (wall.to - wall.from).normalized();
  const Vector2d offset = opening.middle - wall.from;
  const double across = along.x() * offset.y() - along.y() * offset.x();
  const double reach = opening.width_m / 2.0 + margin_m;
  const double place = offset.dot(along);
  return std::abs(across) < kAcross_m && place > begin_m - reach && place < end_m + reach;
}

Flight HousePlan::flight() const {
  return {.risers = riser_count(storey_m, 1), .rise_m = storey_m, .tread_m = 0.27, .width_m = kFlightWidth_m};
}

Vector3d HousePlan::foot_of_flight(int level) const {
  return {-flight().run_m() / 2.0, kHallHalf_m - kFlightWidth_m / 2.0, floor_of(level)};
}

Eigen::AlignedBox2d HousePlan::stairwell() const {
  const Vector3d foot = foot_of_flight(0);
  return {Vector2d(foot.x(), kHallHalf_m - kFlightWidth_m), Vector2d(foot.x() + flight().run_m(), kHallHalf_m)};
}

std::vector<HouseRoom> HousePlan::rooms() const {
  const double third = half.x() / 3.0;
  const std::array<double, 3> west = {-half.x(), -third + kPartition_m, third + kPartition_m};
  const std::array<double, 3> east = {-third, third, half.x()};
  const double hall = kHallHalf_m + kPartition_m;
  std::vector<HouseRoom> rooms;
  for (std::size_t i = 0; i < 3; ++i) {
    rooms.push_back({{west[i], hall}, {east[i], half.y()}, i != 1});
    rooms.push_back({{west[i], -half.y()}, {east[i], -hall}, i != 1});
  }
  return rooms;
}

std::vector<HouseOpening> HousePlan::inner_doors() const {
  std::vector<HouseOpening> doors;
  const double hall = kHallHalf_m + kPartition_m / 2.0;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) {
      doors.push_back({.middle = {end * door_x(), side * hall}});
      doors.push_back({.middle = {end * half.x() / 3.0 + kPartition_m / 2.0, side * row_y()}});
    }
  }
  doors.push_back({.middle = {0.0, -hall}});
  return doors;
}

std::vector<HouseOpening> HousePlan::outer_openings(int level) const {
  constexpr double kSill_m = 0.9;
  constexpr double kTop_m = 2.1;
  if (level == 0) return {};
  std::vector<HouseOpening> openings;
  for (const HouseRoom& room : rooms()) {
    const double side = room.low.y() > 0.0 ? 1.0 : -1.0;
    openings.push_back({{room.middle().x(), side * half.y()}, 1.7, kTop_m, kSill_m});
    if (!room.corner) continue;
    const double end = room.low.x() > 0.0 ? 1.0 : -1.0;
    openings.push_back({{end * half.x(), room.middle().y()}, 1.3, kTop_m, kSill_m});
  }
  openings.push_back({{-half.x(), 0.0}, 1.2, kTop_m, kSill_m});
  if (level == 1) {
    openings.push_back({{half.x(), 0.0}, 1.2, kTop_m, 0.0});
  } else {
    openings.push_back({{half.x(), 0.0}, 1.2, kTop_m, kSill_m});
  }
  return openings;
}

std::vector<Wall> HousePlan::inner_walls(int level) const {
  const double x = half.x();
  const double hall = kHallHalf_m;
  const double third = x / 3.0;
  std::vector<Wall> walls(6);
  walls[0].from = {-x, -hall};
  walls[0].to = {x, -hall};
  walls[1].from = {x, hall};
  walls[1].to = {-x, hall};
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = i == 0 ? -third : third;
    walls[2 + i].from = {at, hall + kPartition_m};
    walls[2 + i].to = {at, half.y()};
    walls[4 + i].from = {at, -half.y()};
    walls[4 + i].to = {at, -hall - kPartition_m};
  }
  for (Wall& wall : walls) {
    wall.height_m = clear_m();
    wall.thickness_m = kPartition_m;
    wall.floor_m = floor_of(level);
    cut(wall, inner_doors());
  }
  return walls;
}

std::vector<Wall> HousePlan::outer_walls(int level) const {
  std::vector<Wall> walls = rectangle_walls(half, storey_m);
  for (Wall& wall : walls) {
    wall.thickness_m = kOuterWall_m;
    wall.floor_m = floor_of(level);
    cut(wall, outer_openings(level));
  }
  return walls;
}

std::vector<Route> HousePlan::routes() const {
  return {all_floors(*this), first_floor(*this), rectangular_route("exterior", Vector3d::Zero(), way_half(), 2.0)};
}

}  // namespace plumbline
