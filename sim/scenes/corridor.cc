#include "sim/scenes/corridor.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/corridor_legs.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kWallM = Leg::kWallM;
constexpr double kDoorWidthM = 1.0;
constexpr double kDoorHeightM = 2.05;
constexpr double kDoorShare = 0.75;  // of the places for one that have a door
constexpr double kNarrowM = 2.3;     // no cabinets in corridors narrower than this

/// Middles of equal slots along a wall, clear of its ends.
std::vector<double> slots(double wall_length, double spacing) {
  constexpr double kClearOfCorners = 0.8;
  const double usable = wall_length - 2.0 * kClearOfCorners;
  const int count = static_cast<int>(usable / spacing);
  std::vector<double> middles;
  for (int i = 0; i < count; ++i) middles.push_back(kClearOfCorners + usable * (i + 0.5) / count);
  return middles;
}

// Closed doors, set back in their wall behind a threshold.
void add_door(MjcfWriter& writer, const Wall& wall, const Opening& opening, RandomStream& stream) {
  writer.box(pick(stream, {"door_paint", "door_oak"}), {opening.begin_m, -kWallM, 0.0},
             {opening.end_m, -kWallM + 0.05, opening.height_m}, frame_of(wall));
  writer.box("frame_paint", {opening.begin_m, -kWallM, -0.2}, {opening.end_m, 0.0, 0.0}, frame_of(wall));
  add_door_frame(writer, wall, opening);
}

void add_wall_thing(MjcfWriter& writer, const Leg& leg, const Pose& world_from_wall, double along,
                    RandomStream& stream) {
  const double kind = stream.uniform();
  Fixture fixture{.material = "plaster", .along_m = along + stream.uniform(-0.1, 0.1)};
  if (kind < 0.3) {  // pilaster
    fixture.height_m = leg.height / 2.0;
    fixture.width_m = 0.4;
    fixture.tall_m = leg.height;
    fixture.depth_m = 0.15;
  } else if (kind < 0.65) {
    fixture.material = pick(stream, sign_materials());
    fixture.height_m = stream.uniform(1.4, 1.7);
    fixture.width_m = stream.uniform(0.6, 1.0);
    fixture.tall_m = stream.uniform(0.5, 0.9);
    fixture.depth_m = 0.03;
  } else if (kind < 0.82 || 2.0 * leg.half_width < kNarrowM) {  // radiator
    fixture.material = "panels_white";
    fixture.height_m = 0.45;
    fixture.width_m = 1.0;
    fixture.tall_m = 0.6;
    fixture.depth_m = 0.12;
  } else {
    fixture.material = pick(stream, {"steel", "panels_grey", "door_oak"});
    fixture.height_m = 0.9;
    fixture.width_m = 0.9;
    fixture.tall_m = 1.8;
    fixture.depth_m = 0.25;
  }
  add_fixture(writer, world_from_wall, fixture);
}

// Doors in the middles of the slots, other things between them.
void add_side(MjcfWriter& writer, const Leg& leg, int side, double door_spacing, std::uint64_t seed) {
  RandomStream stream(seed, leg.name + (side == Leg::kLeft ? "/left" : "/right"));
  Wall wall = side_wall(leg, side);
  const std::vector<double> middles = slots((wall.to - wall.from).norm(), door_spacing);
  for (const double middle : middles) {
    if (stream.uniform() >= kDoorShare) continue;
    wall.openings.push_back({middle - kDoorWidthM / 2.0, middle + kDoorWidthM / 2.0, kDoorHeightM});
    add_door(writer, wall, wall.openings.back(), stream);
  }
  add_wall(writer, wall, wall_materials(), stream);
  for (std::size_t i = 1; i < middles.size(); ++i) {
    add_wall_thing(writer, leg, frame_of(wall), (middles[i - 1] + middles[i]) / 2.0, stream);
  }
}

// Flush stretches of differing ground.
void add_floor_and_ceiling(MjcfWriter& writer, const Leg& leg, RandomStream& stream) {
  const double y = leg.floor_half_width();
  std::string floor;
  std::string ceiling;
  const std::vector<double> cuts = random_cuts(stream, leg.floor_begin(), leg.floor_end(), 3.0, 6.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    floor = pick_other_than(floor, stream, indoor_floor_materials());
    ceiling = pick_other_than(ceiling, stream, {"plaster", "panels_white", "panels_grey"});
    writer.box(floor, {cuts[i - 1], -y, -0.2}, {cuts[i], y, 0.0}, leg.world_from_leg);
    writer.box(ceiling, {cuts[i - 1], -y, leg.height}, {cuts[i], y, leg.height + 0.2}, leg.world_from_leg);
  }
}

void add_lamps(MjcfWriter& writer, const Leg& leg, const Unlit& unlit, RandomStream& stream) {
  constexpr double kSpacing = 6.0;
  const int count = std::max(1, static_cast<int>(leg.length / kSpacing));
  for (int i = 0; i < count; ++i) {
    const double along = leg.length * (i + 0.5) / count + stream.uniform(-0.5, 0.5);
    const double y = stream.uniform(-0.2, 0.2);
    if (along > unlit.from_m && along < unlit.to_m) continue;
    writer.box("lamp_housing", {along - 0.5, y - 0.1, leg.height - 0.06}, {along + 0.5, y + 0.1, leg.height},
               leg.world_from_leg);
    writer.lamp(
        {leg.world_from_leg * Eigen::Vector3d(along, y, leg.height - 0.35), stream.uniform(120.0, 200.0), 11.0});
  }
}

void add_cable_tray(MjcfWriter& writer, const Leg& leg) {
  const double y = leg.half_width - 0.12;
  writer.cylinder("pipe_galvanised", {leg.wall_begin(Leg::kLeft), y, leg.height - 0.12},
                  {leg.wall_end(Leg::kLeft), y, leg.height - 0.12}, 0.05, leg.world_from_leg);
}

SceneDescription build_corridor(const SceneValues& values, std::uint64_t world_seed) {
  MjcfWriter writer;
  const auto turns = static_cast<std::size_t>(std::lround(values.at("turns")));
  const std::vector<double> lengths(turns + 1, values.at("length_m") / static_cast<double>(turns + 1));
  const std::vector<Leg> legs = make_legs("corridor", lengths, values.at("width_m"), values.at("height_m"));
  for (const Leg& leg : legs) add_corridor_leg(writer, leg, values.at("door_spacing_m"), world_seed);
  RandomStream ends(world_seed, "corridor/ends");
  add_wall(writer, first_wall(legs.front()), wall_materials(), ends);
  add_wall(writer, last_wall(legs.back()), wall_materials(), ends);
  SceneDescription scene = writer.finish("corridor", scene_palette(), 30.0, 0.0);
  scene.routes = {centre_line("centre_line", legs)};
  return scene;
}

}  // namespace

void add_corridor_leg(MjcfWriter& writer, const Leg& leg, double door_spacing_m, std::uint64_t seed,
                      const Unlit& unlit) {
  add_side(writer, leg, Leg::kLeft, door_spacing_m, seed);
  add_side(writer, leg, Leg::kRight, door_spacing_m, seed);
  RandomStream grounds(seed, leg.name + "/grounds");
  add_floor_and_ceiling(writer, leg, grounds);
  RandomStream lamps(seed, leg.name + "/lamps");
  add_lamps(writer, leg, unlit, lamps);
  add_cable_tray(writer, leg);
}

SceneInfo corridor_scene() {
  return {.name = "corridor",
          .summary = "office corridor with turns, recessed doors, boards, radiators and cabinets",
          .parameters = {{"length_m", 84, 60, 400, "of the centre line, all legs together"},
                         {"turns", 3, 0, 8, "left and right by turns", true},
                         {"width_m", 2.5, 1.8, 4, "from wall to wall"},
                         {"height_m", 2.6, 2.4, 4, "of the ceiling"},
                         {"door_spacing_m", 4, 2.5, 20, "between places for a door"}},
          .build = build_corridor};
}

}  // namespace plumbline
