#include "sim/scenes/conference_room.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/scenes/furniture.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/room_shell.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kWayAroundTableM = 1.35;  // from the walls to the middle of the way around the table

struct RoomPlan {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  double height = 0.0;
  double furniture = 0.0;
  std::uint64_t seed = 0;

  Eigen::Vector2d table() const { return {2.0 * half.x() - 5.0, std::min(2.0 * half.y() - 4.8, 1.6)}; }
};

void add_papers(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector3d& at, double yaw) {
  const Pose frame = upright_frame(at, yaw + stream.uniform(-0.3, 0.3));
  writer.box("sign_white", {-0.1, -0.15, 0.0}, {0.1, 0.15, 0.005}, frame);
  if (stream.uniform() < 0.5) {  // a laptop in front of them
    writer.box("plastic_black", {0.12, -0.17, 0.0}, {0.34, 0.17, 0.02}, frame);
    writer.box("sign_blue", {0.33, -0.17, 0.0}, {0.345, 0.17, 0.22}, frame);
  } else {
    writer.cylinder("plastic_white", {0.05, 0.25, 0.0}, {0.05, 0.25, 0.09}, 0.04, frame);
  }
}

void add_table_and_chairs(MjcfWriter& writer, const RoomPlan& plan) {
  constexpr double kSeatM = 0.8;
  RandomStream stream(plan.seed, "conference_room/table");
  const Eigen::Vector2d table = plan.table();
  add_table(writer, stream, {}, table);
  const int seats = std::max(1, static_cast<int>(table.x() / kSeatM));
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < seats; ++i) {
      const double x = table.x() * ((i + 0.5) / seats - 0.5) + stream.uniform(-0.08, 0.08);
      const double y = side * (table.y() / 2.0 + stream.uniform(0.10, 0.25));
      add_chair(writer, stream, upright_frame({x, y, 0.0}, -side * M_PI / 2.0 + stream.uniform(-0.2, 0.2)));
      add_papers(writer, stream, {x, side * (table.y() / 2.0 - 0.3), 0.74}, -side * M_PI / 2.0);
    }
    add_chair(writer, stream, upright_frame({side * (table.x() / 2.0 + 0.2), 0.0, 0.0}, side > 0.0 ? M_PI : 0.0));
  }
}

// Panes in frames, not to be seen through.
void add_window(MjcfWriter& writer, const Pose& world_from_wall, double along, double width, double ceiling) {
  const double tall = ceiling - 1.3;
  const double middle = 0.9 + tall / 2.0;
  add_fixture(writer, world_from_wall,
              {.material = "frame_paint", .along_m = along, .height_m = middle, .width_m = width, .tall_m = tall});
  for (const double side : {-1.0, 1.0}) {
    add_fixture(writer, world_from_wall,
                {.material = "glass",
                 .along_m = along + side * width / 4.0,
                 .height_m = middle,
                 .width_m = width / 2.0 - 0.12,
                 .tall_m = tall - 0.14,
                 .depth_m = 0.03});
  }
  add_fixture(writer, world_from_wall,  // radiator
              {.material = "panels_white",
               .along_m = along,
               .height_m = 0.45,
               .width_m = width - 0.3,
               .tall_m = 0.6,
               .depth_m = 0.12});
}

void add_things_at_walls(MjcfWriter& writer, const RoomPlan& plan, const std::vector<Wall>& walls) {
  RandomStream stream(plan.seed, "conference_room/walls");
  const auto place = [&](const Wall& wall, double share) {
    return frame_of(wall) * upright_frame({share * (wall.to - wall.from).norm(), 0.0, 0.0}, 0.0);
  };
  const double along_x = (walls[0].to - walls[0].from).norm();
  const int windows = static_cast<int>(along_x / 2.4);
  for (int i = 0; i < windows; ++i) {
    add_window(writer, frame_of(walls[0]), along_x * (i + 0.5) / windows + stream.uniform(-0.15, 0.15), 1.7,
               plan.height);
  }
  add_fixture(writer, place(walls[1], 0.5),
              {.material = "white_board", .height_m = 1.5, .width_m = 2.4, .tall_m = 1.2, .depth_m = 0.04});
  add_fixture(writer, place(walls[3], 0.5),
              {.material = "plastic_black", .height_m = 1.5, .width_m = 1.6, .tall_m = 0.9, .depth_m = 0.08});
  add_cupboard(writer, stream, place(walls[3], 0.15), {1.2, 0.45, 0.8});
  add_picture(writer, stream, place(walls[1], 0.12), 1.6);
  for (double share = 0.12; share < 0.7; share += 1.5 / along_x) {
    const bool taken = stream.uniform() < plan.furniture;
    const double kind = stream.uniform();
    RandomStream own(plan.seed, "conference_room/place" + std::to_string(std::lround(100.0 * share)));
    if (!taken) {
      add_picture(writer, own, place(walls[2], share), own.uniform(1.4, 1.7));
    } else if (kind < 0.5) {
      add_bookcase(writer, own, place(walls[2], share), 1.1, own.uniform(1.2, 2.1));
    } else {
      add_cupboard(writer, own, place(walls[2], share), {1.1, 0.45, own.uniform(0.8, 1.9)});
    }
  }
  const Eigen::Vector2d corner = plan.half - Eigen::Vector2d::Constant(0.45);
  add_plant(writer, stream, upright_frame({corner.x(), corner.y(), 0.0}, 0.0), 1.5);
  add_plant(writer, stream, upright_frame({-corner.x(), -corner.y(), 0.0}, 1.0), 1.3);
}

SceneDescription build_conference_room(const SceneValues& values, std::uint64_t world_seed) {
  const RoomPlan plan{.half = {values.at("length_m") / 2.0, values.at("width_m") / 2.0},
                      .height = values.at("height_m"),
                      .furniture = values.at("furniture"),
                      .seed = world_seed};
  MjcfWriter writer;
  RandomStream shell_stream(world_seed, "conference_room/shell");
  RoomShell shell{.half_size = plan.half,
                  .height_m = plan.height,
                  .floors = {"carpet_grey", "carpet_blue", "wood_floor"},
                  .walls = room_wall_materials()};
  shell.door_along_m = 2.0 * plan.half.x() - 1.0;
  const std::vector<Wall> walls = add_room_shell(writer, shell_stream, shell);
  add_things_at_walls(writer, plan, walls);
  add_table_and_chairs(writer, plan);
  RandomStream lamps(world_seed, "conference_room/lamps");
  add_ceiling_lamps(writer, lamps, shell, 2.6, 90.0);
  SceneDescription scene = writer.finish("conference_room", scene_palette(), 30.0, 0.0);
  const Eigen::Vector2d way = plan.half - Eigen::Vector2d::Constant(kWayAroundTableM);
  scene.routes = {rectangular_route("around_the_table", Eigen::Vector3d::Zero(), way, 0.7)};
  return scene;
}

}  // namespace

SceneInfo conference_room_scene() {
  return {.name = "conference_room",
          .summary = "furnished room with a long table to walk around",
          .parameters = {{"length_m", 8, 7, 16, "along x"},
                         {"width_m", 6, 5.6, 12, "along y"},
                         {"height_m", 3, 2.5, 4, "of the ceiling"},
                         {"furniture", 0.8, 0, 1, "share of the places at the wall that are taken"}},
          .build = build_conference_room};
}

}  // namespace plumbline
