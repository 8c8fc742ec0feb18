#include "sim/scenes/houses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kInGround_m = 2.0;  // below the origin, for houses on slopes

/// One outer wall: its frame lies in the wall like the house's in the front.
struct Facade {
  Pose world_from_wall;
  double width = 0.0;
};

void add_window(Scenery& scenery, RandomStream& stream, const Pose& frame, double x, double sill, double width,
                double height, bool shutters) {
  const double left = x - 0.5 * width;
  const double right = x + 0.5 * width;
  const double top = sill + height;
  // The frame stands out of the wall, the panes lie in it.
  scenery.block("frame_white", {left - 0.08, -0.07, sill - 0.02}, {right + 0.08, 0.0, top + 0.08}, frame);
  const double bar = stream.uniform() < 0.6 ? 0.03 : 0.0;
  const auto pane = [&](double from, double to) {
    const double y = -0.075;
    scenery.quad("glass", frame * Vector3d(from, y, sill + 0.05), frame * Vector3d(to, y, sill + 0.05),
                 frame * Vector3d(to, y, top), frame * Vector3d(from, y, top));
  };
  if (bar > 0.0) {
    pane(left, x - bar);
    pane(x + bar, right);
  } else {
    pane(left, right);
  }
  scenery.block("stone_pale", {left - 0.12, -0.16, sill - 0.10}, {right + 0.12, 0.0, sill - 0.02}, frame);
  if (!shutters) return;
  for (const double side : {-1.0, 1.0}) {
    const double inner = x + side * (0.5 * width + 0.1);
    const double outer = inner + side * 0.45 * width;
    scenery.block("shutter_green", {std::min(inner, outer), -0.06, sill}, {std::max(inner, outer), 0.0, top}, frame);
  }
}

void add_balcony(Scenery& scenery, const Pose& frame, double x, double floor_z, double width) {
  const double half = 0.5 * width;
  scenery.box("concrete_pale", {x - half, -1.2, floor_z - 0.16}, {x + half, 0.0, floor_z}, frame);
  scenery.box("railing", {x - half, -1.2, floor_z + 0.1}, {x + half, -1.15, floor_z + 1.0}, frame);
  for (const double side : {-half, half - 0.05}) {
    scenery.box("railing", {x + side, -1.15, floor_z + 0.1}, {x + side + 0.05, 0.0, floor_z + 1.0}, frame);
  }
}

void add_door(Scenery& scenery, RandomStream& stream, const Pose& frame, double x) {
  const double half = stream.uniform(0.5, 0.7);
  const double top = stream.uniform(2.1, 2.4);
  scenery.block("frame_white", {x - half - 0.12, -0.10, -0.5}, {x + half + 0.12, 0.0, top + 0.12}, frame);
  scenery.quad(stream.uniform() < 0.5 ? "door_oak" : "door_paint", frame * Vector3d(x - half, -0.105, 0.0),
               frame * Vector3d(x + half, -0.105, 0.0), frame * Vector3d(x + half, -0.105, top),
               frame * Vector3d(x - half, -0.105, top));
  scenery.block("stone_pale", {x - half - 0.3, -0.7, -0.6}, {x + half + 0.3, 0.0, 0.14}, frame);
  if (stream.uniform() < 0.5) {
    scenery.box("concrete_dark", {x - half - 0.4, -0.9, top + 0.35}, {x + half + 0.4, 0.0, top + 0.47}, frame);
  }
}

void add_shop(Scenery& scenery, RandomStream& stream, const Facade& facade, double floor_height) {
  const Pose& frame = facade.world_from_wall;
  const double half = 0.5 * facade.width - 0.4;
  const double top = floor_height - 0.9;
  const std::string sign = pick(stream, sign_materials());
  scenery.block("frame_paint", {-half, -0.08, -0.5}, {half, 0.0, top + 0.1}, frame);
  const int panes = std::max(2, static_cast<int>(facade.width / 2.4));
  const int door = stream.integer(0, panes - 1);
  for (int i = 0; i < panes; ++i) {
    const double left = -half + 2.0 * half * i / panes + 0.1;
    const double right = -half + 2.0 * half * (i + 1) / panes - 0.1;
    const double low = i == door ? 0.05 : 0.55;
    scenery.quad("glass", frame * Vector3d(left, -0.085, low), frame * Vector3d(right, -0.085, low),
                 frame * Vector3d(right, -0.085, top), frame * Vector3d(left, -0.085, top));
  }
  scenery.box(sign, {-half, -0.22, top + 0.12}, {half, 0.0, floor_height - 0.15}, frame);
  if (stream.uniform() < 0.5) {
    scenery.sheet(stream.uniform() < 0.5 ? "awning_red" : "awning_blue", frame * Vector3d(-half, 0.0, top + 0.1),
                  frame * Vector3d(-half, -1.2, top - 0.4), frame * Vector3d(half, -1.2, top - 0.4),
                  frame * Vector3d(half, 0.0, top + 0.1));
  }
}

/// Windows in columns, the same for all floors of a house, as built.
void add_windows(Scenery& scenery, RandomStream& stream, const Facade& facade, const House& house, bool front) {
  const double pitch = stream.uniform(2.3, 3.1);
  const int columns = static_cast<int>((facade.width - 0.8) / pitch);
  if (columns < 1) return;
  const double width = stream.uniform(0.9, 1.5);
  const double height = stream.uniform(1.2, 1.7);
  const double sill = stream.uniform(0.75, 0.95);
  const bool shutters = house.floors <= 3 && pitch - 1.9 * width > 0.35 && stream.uniform() < 0.5;
  const int door = front && !house.shop ? stream.integer(0, columns - 1) : -1;
  const int balcony = stream.integer(0, columns - 1);
  for (int floor = front && house.shop ? 1 : 0; floor < house.floors; ++floor) {
    for (int column = 0; column < columns; ++column) {
      const double x = (column - 0.5 * (columns - 1)) * pitch;
      const double base = floor * house.floor_m;
      if (floor == 0 && column == door) {
        add_door(scenery, stream, facade.world_from_wall, x);
        continue;
      }
      if (!front && stream.uniform() < 0.35) continue;  // walled up
      add_window(scenery, stream, facade.world_from_wall, x, base + sill, width, height, shutters);
      const bool stands_out = front && house.balconies && floor > 0 && column % 3 == balcony % 3;
      if (stands_out) add_balcony(scenery, facade.world_from_wall, x, base, std::min(2.6, pitch + 0.3));
    }
  }
}

/// Gable roofs have overhanging eaves; a flat one has a parapet and what stands on it.
void add_gable_roof(Scenery& scenery, RandomStream& stream, const Pose& frame, const House& house) {
  constexpr double kOverhang_m = 0.45;
  constexpr double kThick_m = 0.18;
  const bool along = house.roof == Roof::kGableAlong;
  const double span = along ? house.depth_m : house.width_m;
  const double run = along ? house.width_m : house.depth_m;
  const double eaves = house.floors * house.floor_m;
  const double rise = 0.5 * span * std::tan(stream.uniform(0.55, 0.85));
  // The roof's own frame has its ridge along y, above its origin.
  const Vector3d middle(0.0, 0.5 * house.depth_m, eaves);
  const Pose roof = frame * upright_frame(middle, along ? 0.5 * std::numbers::pi : 0.0);
  const double half = 0.5 * span;
  const double slope = rise / half;
  scenery.prism(house.wall, {{-half, -0.02}, {half, -0.02}, {0.0, rise}}, -0.5 * run, 0.5 * run, roof);
  for (const double side : {-1.0, 1.0}) {
    const double foot = side * (half + kOverhang_m);
    const double low = -slope * kOverhang_m;
    std::vector<Eigen::Vector2d> profile = {{foot, low}, {0.0, rise}, {0.0, rise + kThick_m}, {foot, low + kThick_m}};
    if (side > 0.0) std::reverse(profile.begin(), profile.end());
    scenery.prism(house.roofing, profile, -0.5 * run - kOverhang_m, 0.5 * run + kOverhang_m, roof);
  }
  const double y = stream.uniform(-0.35, 0.35) * run;
  const double x = stream.uniform(-0.25, 0.25) * span;
  const double top = rise + stream.uniform(0.5, 1.0);
  scenery.block("brick_red", {x - 0.35, y - 0.3, 0.3 * rise}, {x + 0.35, y + 0.3, top}, roof);
}

void add_flat_roof(Scenery& scenery, RandomStream& stream, const Pose& frame, const House& house) {
  const double top = house.floors * house.floor_m;
  const double half = 0.5 * house.width_m;
  scenery.quad("roof_gravel", frame * Vector3d(-half, 0.0, top), frame * Vector3d(half, 0.0, top),
               frame * Vector3d(half, house.depth_m, top), frame * Vector3d(-half, house.depth_m, top));
  const double parapet = stream.uniform(0.4, 0.9);
  const double out = 0.15;
  const auto edge = [&](double x0, double y0, double x1, double y1) {
    scenery.box("stone_pale", {x0, y0, top - 0.25}, {x1, y1, top + parapet}, frame);
  };
  edge(-half - out, -out, half + out, 0.15);
  edge(-half - out, house.depth_m - 0.15, half + out, house.depth_m + out);
  edge(-half - out, 0.15, -half + 0.15, house.depth_m - 0.15);
  edge(half - 0.15, 0.15, half + out, house.depth_m - 0.15);
  const int boxes = stream.integer(1, 3);
  for (int i = 0; i < boxes; ++i) {
    const double x = stream.uniform(-0.6, 0.6) * half;
    const double y = stream.uniform(0.3, 0.7) * house.depth_m;
    scenery.block("panels_grey", {x - stream.uniform(0.6, 1.6), y - 1.0, top},
                  {x + 1.0, y + 1.1, top + stream.uniform(0.9, 2.2)}, frame);
  }
}

Facade side_of(const Pose& house_frame, const House& house, int side) {
  const double half = 0.5 * house.width_m;
  switch (side) {
    case 0:
      return {house_frame, house.width_m};
    case 1:
      return {house_frame * upright_frame({half, 0.5 * house.depth_m, 0.0}, 0.5 * std::numbers::pi), house.depth_m};
    case 2:
      return {house_frame * upright_frame({0.0, house.depth_m, 0.0}, std::numbers::pi), house.width_m};
    default:
      return {house_frame * upright_frame({-half, 0.5 * house.depth_m, 0.0}, -0.5 * std::numbers::pi), house.depth_m};
  }
}

}  // namespace

House draw_town_house(RandomStream& stream, double width_m) {
  House house;
  house.width_m = width_m;
  house.depth_m = stream.uniform(9.0, 13.0);
  house.floors = stream.integer(2, 5);
  house.floor_m = stream.uniform(2.8, 3.5);
  house.wall = pick(stream, facade_materials());
  house.roof = house.floors > 3 && stream.uniform() < 0.6 ? Roof::kFlat : Roof::kGableAlong;
  house.roofing = pick(stream, roof_materials());
  house.shop = stream.uniform() < 0.35;
  house.balconies = stream.uniform() < 0.4;
  house.side_windows = false;
  return house;
}

House draw_villa(RandomStream& stream) {
  House house;
  house.width_m = stream.uniform(8.0, 13.0);
  house.depth_m = stream.uniform(7.5, 11.0);
  house.floors = stream.integer(1, 2);
  house.floor_m = stream.uniform(2.7, 3.1);
  house.wall = pick(stream, facade_materials());
  house.roof = stream.uniform() < 0.5 ? Roof::kGableAlong : Roof::kGableAcross;
  house.roofing = pick(stream, roof_materials());
  house.balconies = stream.uniform() < 0.2;
  return house;
}

void add_house(Scenery& scenery, RandomStream& stream, const Pose& world_from_house, const House& house) {
  const double half = 0.5 * house.width_m;
  const double top = house.floors * house.floor_m;
  scenery.block(house.wall, {-half, 0.0, -kInGround_m}, {half, house.depth_m, top}, world_from_house);
  // A plinth, and a string course above the ground floor.
  scenery.block("stone_dark", {-half - 0.06, -0.06, -kInGround_m}, {half + 0.06, house.depth_m + 0.06, 0.45},
                world_from_house);
  if (house.floors > 2) {
    scenery.box("stone_pale", {-half, -0.10, house.floor_m - 0.12}, {half, 0.0, house.floor_m + 0.08},
                world_from_house);
  }
  for (int side = 0; side < 4; ++side) {
    const bool front = side == 0;
    if (side % 2 == 1 && !house.side_windows) continue;
    const Facade facade = side_of(world_from_house, house, side);
    if (front && house.shop) add_shop(scenery, stream, facade, house.floor_m);
    if (side != 2 || house.side_windows) add_windows(scenery, stream, facade, house, front);
  }
  const double pipe = (stream.uniform() < 0.5 ? -1.0 : 1.0) * (half - 0.2);
  scenery.block("pipe_galvanised", {pipe - 0.06, -0.16, -0.5}, {pipe + 0.06, -0.04, top}, world_from_house);
  if (house.roof == Roof::kFlat) return add_flat_roof(scenery, stream, world_from_house, house);
  add_gable_roof(scenery, stream, world_from_house, house);
}

void add_hall_building(Scenery& scenery, RandomStream& stream, const Pose& world_from_hall, const Hall& hall) {
  const double half = 0.5 * hall.width_m;
  scenery.block(hall.wall, {-half, 0.0, -kInGround_m}, {half, hall.depth_m, hall.eaves_m}, world_from_hall);
  scenery.prism("roof_metal",
                {{-half - 0.3, hall.eaves_m},
                 {half + 0.3, hall.eaves_m},
                 {half + 0.3, hall.eaves_m + 0.25},
                 {0.0, hall.eaves_m + 0.06 * hall.width_m + 0.25},
                 {-half - 0.3, hall.eaves_m + 0.25}},
                -0.3, hall.depth_m + 0.3, world_from_hall);
  // Posts of the frame show outside, every 5 m or so.
  const int bays = std::max(2, static_cast<int>(hall.width_m / 5.0));
  for (int i = 0; i <= bays; ++i) {
    const double x = -half + hall.width_m * i / bays;
    scenery.block("steel", {x - 0.12, -0.22, -1.0}, {x + 0.12, 0.0, hall.eaves_m}, world_from_hall);
    if (i == bays) break;
    const double middle = x + 0.5 * hall.width_m / bays;
    const double kind = stream.uniform();
    if (kind < 0.35) {
      scenery.block("door_paint", {middle - 1.7, -0.08, -0.5}, {middle + 1.7, 0.0, 0.6 * hall.eaves_m},
                    world_from_hall);
    } else if (kind < 0.75) {
      const double sill = 0.55 * hall.eaves_m;
      scenery.block("frame_white", {middle - 1.6, -0.06, sill}, {middle + 1.6, 0.0, sill + 1.2}, world_from_hall);
      scenery.quad("glass", world_from_hall * Vector3d(middle - 1.5, -0.07, sill + 0.1),
                   world_from_hall * Vector3d(middle + 1.5, -0.07, sill + 0.1),
                   world_from_hall * Vector3d(middle + 1.5, -0.07, sill + 1.1),
                   world_from_hall * Vector3d(middle - 1.5, -0.07, sill + 1.1));
    } else {
      scenery.box(pick(stream, sign_materials()), {middle - 1.2, -0.15, 2.4}, {middle + 1.2, 0.0, 3.6},
                  world_from_hall);
    }
  }
}

}  // namespace plumbline
