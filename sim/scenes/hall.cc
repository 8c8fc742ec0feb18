#include "sim/scenes/hall.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/scenes/palette.h"
#include "sim/scenes/parked_things.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kWallM = 0.2;
constexpr double kColumnInsetM = 3.2;  // from a wall to the columns' axes
constexpr double kFreeBelowM = 2.0;    // things on the open floor stay below this

struct HallPlan {
  double half_length = 0.0;
  double half_width = 0.0;
  double height = 0.0;
  double clutter = 0.0;
  double column_spacing = 0.0;
  std::uint64_t seed = 0;
};

std::vector<Wall> walls_of(const HallPlan& plan) {
  return rectangle_walls({plan.half_length, plan.half_width}, plan.height);
}

// Boards of all sizes, above the racks.
void add_boards(MjcfWriter& writer, const Wall& wall, RandomStream& stream) {
  const double length = (wall.to - wall.from).norm();
  for (double along = 3.0; along < length - 2.5; along += 4.5) {
    for (const double height : {wall.height_m * 0.5, wall.height_m * 0.75}) {
      add_fixture(writer, frame_of(wall),
                  {.material = pick(stream, sign_materials()),
                   .along_m = along + stream.uniform(-0.6, 0.6),
                   .height_m = height + stream.uniform(-0.5, 0.5),
                   .width_m = stream.uniform(1.2, 2.6),
                   .tall_m = stream.uniform(0.8, 1.6),
                   .depth_m = 0.04});
    }
  }
}

void add_walls(MjcfWriter& writer, const HallPlan& plan) {
  RandomStream stream(plan.seed, "hall/walls");
  for (const Wall& wall : walls_of(plan)) {
    add_wall(writer, wall, wall_materials(), stream);
    add_boards(writer, wall, stream);
  }
}

void add_floor_and_ceiling(MjcfWriter& writer, const HallPlan& plan) {
  RandomStream stream(plan.seed, "hall/grounds");
  constexpr int kAcross = 5;
  constexpr int kAlong = 6;
  const double x = plan.half_length + kWallM;
  const double y = plan.half_width + kWallM;
  for (int i = 0; i < kAlong; ++i) {
    const double west = -x + 2.0 * x * i / kAlong;
    const double east = -x + 2.0 * x * (i + 1) / kAlong;
    for (int j = 0; j < kAcross; ++j) {
      writer.box(pick(stream, indoor_floor_materials()), {west, -y + 2.0 * y * j / kAcross, -0.2},
                 {east, -y + 2.0 * y * (j + 1) / kAcross, 0.0});
    }
    writer.box(pick(stream, {"panels_grey", "concrete_pale", "panels_white"}), {west, -y, plan.height},
               {east, y, plan.height + 0.2});
  }
}

std::vector<double> column_rows(const HallPlan& plan) {
  const double reach = plan.half_length - kColumnInsetM;
  const int count = std::max(1, static_cast<int>(std::lround(2.0 * reach / plan.column_spacing)));
  std::vector<double> rows;
  for (int i = 0; i <= count; ++i) rows.push_back(-reach + 2.0 * reach * i / count);
  return rows;
}

// Columns with a beam across the hall from each to the one opposite.
void add_columns_and_beams(MjcfWriter& writer, const HallPlan& plan) {
  RandomStream stream(plan.seed, "hall/columns");
  const double y = plan.half_width - kColumnInsetM;
  int row_number = 0;
  for (const double x : column_rows(plan)) {
    const bool round = row_number++ % 2 == 1;
    for (const double side : {-y, y}) {
      const std::string material = pick(stream, {"concrete_pale", "concrete_dark", "brick_red", "sign_yellow"});
      if (round) {
        writer.cylinder(material, {x, side, 0.0}, {x, side, plan.height}, 0.35);
      } else {
        writer.box(material, {x - 0.3, side - 0.3, 0.0}, {x + 0.3, side + 0.3, plan.height});
      }
    }
    writer.box("steel", {x - 0.15, -plan.half_width, plan.height - 0.9},
               {x + 0.15, plan.half_width, plan.height - 0.3});
  }
}

// Uprights, shelves, and crates on those. The rack's frame is the wall's: x along it, y into the hall.
void add_rack(MjcfWriter& writer, const HallPlan& plan, const Pose& world_from_wall, double along,
              RandomStream& stream) {
  constexpr double kLength = 3.6;
  constexpr double kDepth = 1.1;
  constexpr double kTop = 4.2;
  constexpr double kShelfHeight = 1.4;
  for (const double x : {along - kLength / 2.0, along + kLength / 2.0}) {
    writer.box("barrel_orange", {x - 0.05, 0.2, 0.0}, {x + 0.05, 0.2 + kDepth, kTop}, world_from_wall);
  }
  for (double z = kShelfHeight; z < kTop; z += kShelfHeight) {
    writer.box("steel", {along - kLength / 2.0, 0.2, z - 0.05}, {along + kLength / 2.0, 0.2 + kDepth, z + 0.05},
               world_from_wall);
    for (const double offset : {-1.0, 1.0}) {
      if (stream.uniform() >= plan.clutter) continue;
      const Pose stack = upright_frame({along + offset + stream.uniform(-0.2, 0.2), 0.75, z + 0.05}, 0.0);
      add_crates(writer, stream, world_from_wall * stack, kShelfHeight - 0.2);
    }
  }
}

void add_racks(MjcfWriter& writer, const HallPlan& plan) {
  RandomStream stream(plan.seed, "hall/racks");
  for (const Wall& wall : walls_of(plan)) {
    const double length = (wall.to - wall.from).norm();
    for (double along = 5.0; along < length - 4.0; along += 6.0) {
      if (stream.uniform() < 0.3 + 0.5 * plan.clutter) add_rack(writer, plan, frame_of(wall), along, stream);
    }
  }
}

// Crates on the open floor, low enough to fly over.
void add_floor_crates(MjcfWriter& writer, const HallPlan& plan) {
  constexpr double kPitch = 6.0;
  const double x_reach = plan.half_length - 5.0;
  const double y_reach = plan.half_width - 5.0;
  for (double x = -x_reach; x <= x_reach; x += kPitch) {
    for (double y = -y_reach; y <= y_reach; y += kPitch) {
      RandomStream stream(plan.seed,
                          "hall/crate" + std::to_string(std::lround(x)) + "/" + std::to_string(std::lround(y)));
      if (stream.uniform() >= plan.clutter) continue;
      const Eigen::Vector3d foot{x + stream.uniform(-1.5, 1.5), y + stream.uniform(-1.5, 1.5), 0.0};
      add_crates(writer, stream, upright_frame(foot, stream.uniform(0.0, M_PI)), kFreeBelowM);
    }
  }
}

void add_lamps(MjcfWriter& writer, const HallPlan& plan) {
  RandomStream stream(plan.seed, "hall/lamps");
  constexpr double kSpacing = 8.0;
  const int along = static_cast<int>(2.0 * plan.half_length / kSpacing);
  const int across = static_cast<int>(2.0 * plan.half_width / kSpacing);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      const Eigen::Vector3d at{
          -plan.half_length + 2.0 * plan.half_length * (i + 0.5) / along + stream.uniform(-0.8, 0.8),
          -plan.half_width + 2.0 * plan.half_width * (j + 0.5) / across + stream.uniform(-0.8, 0.8), plan.height - 1.2};
      writer.box("lamp_housing", at + Eigen::Vector3d(-0.5, -0.2, 0.2), at + Eigen::Vector3d(0.5, 0.2, 0.3));
      writer.lamp({at, stream.uniform(1200.0, 1800.0), plan.height + 12.0});
    }
  }
}

// Two loops side by side, rising and falling within the free volume above the crates.
Route figure_of_eight(const HallPlan& plan) {
  const int points = static_cast<int>(2.0 * (plan.half_length + plan.half_width));
  const double x = plan.half_length - 7.0;
  const double y = plan.half_width - 6.5;
  const double low = std::max(3.0, 0.3 * plan.height);
  const double high = 0.6 * plan.height;
  Route route{.name = "figure_of_eight", .points = {}, .closed = true, .flown = true};
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * M_PI * i / points;
    route.points.emplace_back(x * std::sin(angle), y * std::sin(2.0 * angle),
                              low + (high - low) * (0.5 + 0.5 * std::sin(angle + 1.0)));
  }
  return route;
}

Route level_flight(const HallPlan& plan) {
  return rectangular_route("level", {0.0, 0.0, 0.4 * plan.height}, {plan.half_length - 7.0, plan.half_width - 6.5},
                           4.0);
}

SceneDescription build_hall(const SceneValues& values, std::uint64_t world_seed) {
  const HallPlan plan{.half_length = values.at("length_m") / 2.0,
                      .half_width = values.at("width_m") / 2.0,
                      .height = values.at("height_m"),
                      .clutter = values.at("clutter"),
                      .column_spacing = values.at("column_spacing_m"),
                      .seed = world_seed};
  MjcfWriter writer;
  add_walls(writer, plan);
  add_floor_and_ceiling(writer, plan);
  add_columns_and_beams(writer, plan);
  add_racks(writer, plan);
  add_floor_crates(writer, plan);
  add_lamps(writer, plan);
  SceneDescription scene = writer.finish("hall", scene_palette(), 40.0, 0.0);
  scene.routes = {figure_of_eight(plan), flown(level_flight(plan))};
  return scene;
}

}  // namespace

SceneInfo hall_scene() {
  return {.name = "hall",
          .summary = "large hall for flying, with columns, racks and crates around a free middle",
          .parameters = {{"length_m", 40, 24, 120, "along x"},
                         {"width_m", 30, 20, 80, "along y"},
                         {"height_m", 12, 6, 25, "of the ceiling"},
                         {"clutter", 0.6, 0, 1, "share of the places for crates that are taken"},
                         {"column_spacing_m", 7, 3, 30, "between columns along the hall"}},
          .build = build_hall};
}

}  // namespace plumbline
