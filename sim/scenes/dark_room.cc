#include "sim/scenes/dark_room.h"

#include <array>
#include <cmath>

#include "sim/scenes/furniture.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/parked_things.h"
#include "sim/scenes/room_shell.h"
#include "sim/scenes/routes.h"

namespace plumbline {
namespace {

constexpr double kWayM = 1.6;  // from the walls to the middle of the way around

void add_thing_at_wall(MjcfWriter& writer, RandomStream& stream, const Pose& place, double ceiling) {
  const double kind = stream.uniform();
  if (kind < 0.25) {
    add_shelf(writer, stream, place, 1.6, ceiling - 0.7);
  } else if (kind < 0.45) {
    add_bookcase(writer, stream, place, 1.3, ceiling - 0.9);
  } else if (kind < 0.6) {
    add_sofa(writer, stream, place, 1.8);
  } else if (kind < 0.8) {
    add_cupboard(writer, stream, place, {1.3, 0.5, stream.uniform(0.9, 2.0)});
  } else {
    add_desk(writer, stream, place, false);
  }
}

void add_things_at_walls(MjcfWriter& writer, const std::vector<Wall>& walls, std::uint64_t seed) {
  constexpr double kPitchM = 2.1;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double length = (walls[i].to - walls[i].from).norm();
    const int places = static_cast<int>((length - 2.0) / kPitchM);
    for (int k = 0; k < places; ++k) {
      const double along = 1.0 + (length - 2.0) * (k + 0.5) / places;
      const bool at_door = !walls[i].openings.empty() && std::abs(along - walls[i].openings[0].begin_m - 0.5) < 1.6;
      RandomStream stream(seed, "dark_room/place" + std::to_string(i) + "/" + std::to_string(k));
      const Pose place = frame_of(walls[i]) * upright_frame({along + stream.uniform(-0.1, 0.1), 0.0, 0.0}, 0.0);
      if (at_door) continue;
      add_thing_at_wall(writer, stream, place, walls[i].height_m);
      add_picture(writer, stream, place * upright_frame({0.0, 0.0, 0.0}, 0.0), walls[i].height_m - 0.45);
    }
  }
}

// Tables and crates in the middle, with a way around them.
void add_middle(MjcfWriter& writer, const Eigen::Vector2d& half, std::uint64_t seed) {
  RandomStream stream(seed, "dark_room/middle");
  const double x = half.x() - kWayM - 0.8;
  const double y = half.y() - kWayM - 0.8;
  add_table(writer, stream, upright_frame({-0.5 * x, 0.0, 0.0}, 0.0), {std::min(1.6, 0.9 * x), std::min(0.9, y)});
  add_crates(writer, stream, upright_frame({0.6 * x, 0.5 * y - 0.4, 0.0}, stream.uniform(0.0, 1.0)), 1.6);
  add_plant(writer, stream, upright_frame({0.1 * x, -0.3 * y, 0.0}, 0.0), 1.4);
}

SceneDescription build_dark_room(const SceneValues& values, std::uint64_t world_seed) {
  MjcfWriter writer;
  RandomStream shell_stream(world_seed, "dark_room/shell");
  const RoomShell shell{.half_size = {values.at("length_m") / 2.0, values.at("width_m") / 2.0},
                        .height_m = values.at("height_m"),
                        .floors = {"wood_floor", "carpet_grey", "floor_screed"},
                        .walls = room_wall_materials(),
                        .door_along_m = 1.5};
  const std::vector<Wall> walls = add_room_shell(writer, shell_stream, shell);
  add_things_at_walls(writer, walls, world_seed);
  add_middle(writer, shell.half_size, world_seed);

  constexpr double kLampCd = 0.5;  // half a candle
  RandomStream lamps(world_seed, "dark_room/lamps");
  const auto count = std::lround(values.at("lamp_count"));
  const Eigen::Vector2d corner = shell.half_size - Eigen::Vector2d::Constant(kWayM);
  const std::array<Eigen::Vector2d, 4> places = {corner, -corner, {corner.x(), -corner.y()}, {-corner.x(), corner.y()}};
  for (long i = 0; i < count; ++i) {
    const Eigen::Vector2d& at = places[static_cast<std::size_t>(i)];
    writer.lamp({{at.x(), at.y(), 2.2}, kLampCd * lamps.uniform(0.7, 1.3), 12.0});
  }
  SceneDescription scene = writer.finish("dark_room", scene_palette(), 0.005, 0.0);
  scene.routes = {rectangular_route("around", Eigen::Vector3d::Zero(), corner, 0.8)};
  return scene;
}

}  // namespace

SceneInfo dark_room_scene() {
  return {.name = "dark_room",
          .summary = "furnished room, lit by a night lamp or by nothing",
          .parameters = {{"length_m", 10, 8, 20, "along x"},
                         {"width_m", 8, 7, 16, "along y"},
                         {"height_m", 3, 2.6, 4, "of the ceiling"},
                         {"lamp_count", 1, 0, 4, "night lamps in the corners", true}},
          .build = build_dark_room,
          .usual_lux = 0.1};
}

}  // namespace plumbline
