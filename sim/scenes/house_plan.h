#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "sim/scenes/stairs.h"
#include "sim/scenes/walls.h"
#include "sim/world.h"

namespace plumbline {

/// A door or window in some wall of a level: where its middle is in the plan.
struct HouseOpening {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double width_m = 1.1;
  double top_m = 2.05;  ///< above the floor
  double sill_m = 0.0;  ///< 0: a door
};

struct HouseRoom {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  bool corner = false;  ///< at an end of its row, where its outer part is no way through

  Eigen::Vector2d middle() const { return (low + high) / 2.0; }
};

/// The measures of a house about the origin. All four levels have one plan: a hall along x with the stairs at its
/// north wall, three rooms to its north and three to its south, with doors from room to room.
struct HousePlan {
  static constexpr int kLevels = 4;                 ///< basement, first, second and third floor
  static constexpr double kSlab_m = 0.25;           ///< thickness of floors
  static constexpr double kPartition_m = 0.12;      ///< thickness of inner walls
  static constexpr double kOuterWall_m = 0.2;       ///< thickness of outer walls
  static constexpr double kHallHalf_m = 2.1;        ///< half the width of the hall
  static constexpr double kFirstFloor_m = 0.15;     ///< above the garden
  static constexpr double kDoorToEnd_m = 3.5;       ///< from the doors of the corner rooms to the ends of the house
  static constexpr double kWayToOuterWall_m = 3.0;  ///< of the way around the house

  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< half the size within the outer walls
  double storey_m = 2.8;                           ///< from floor to floor
  double furniture = 0.0;
  int trees = 0;
  std::uint64_t seed = 0;

  double floor_of(int level) const { return kFirstFloor_m + (level - 1) * storey_m; }
  double clear_m() const { return storey_m - kSlab_m; }
  Eigen::Vector2d outer_half() const { return half + Eigen::Vector2d::Constant(kOuterWall_m); }
  Eigen::Vector2d way_half() const { return outer_half() + Eigen::Vector2d::Constant(kWayToOuterWall_m); }

  /// From one level to the next; all three flights stand one above the other.
  Flight flight() const;
  Eigen::Vector3d foot_of_flight(int level) const;
  /// Of the hole in the floors of the upper levels, in the plan.
  Eigen::AlignedBox2d stairwell() const;

  double door_x() const { return half.x() - kDoorToEnd_m; }  ///< of the corner rooms' doors, to both sides
  double row_y() const { return (kHallHalf_m + kPartition_m + half.y()) / 2.0; }  ///< middle of the rooms, both sides
  std::vector<HouseRoom> rooms() const;
  std::vector<HouseOpening> inner_doors() const;
  std::vector<HouseOpening> outer_openings(int level) const;
  std::vector<Wall> inner_walls(int level) const;  ///< with their doors
  std::vector<Wall> outer_walls(int level) const;  ///< with windows and the front door, which looks along +x

  /// `all_floors`, `first_floor` and `exterior`.
  std::vector<Route> routes() const;
};

/// Whether an opening lies in the wall, less than `margin_m` before, behind or between two places along it.
bool is_in_wall(const HouseOpening& opening, const Wall& wall, double begin_m, double end_m, double margin_m);

}  // namespace plumbline
