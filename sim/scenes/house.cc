#include "sim/scenes/house.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/house_garden.h"
#include "sim/scenes/house_plan.h"
#include "sim/scenes/house_rooms.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/site_things.h"

namespace plumbline {
namespace {

constexpr double kCeiling_m = 0.1;  // the part of a floor that is the ceiling below

// Floors and ceilings in flush parts, around the stairwell.
void add_slab(MjcfWriter& writer, const HousePlan& plan, int level, const std::vector<std::string>& looks) {
  RandomStream stream(plan.seed, "house/slab" + std::to_string(level));
  const Eigen::AlignedBox2d well = plan.stairwell();
  const double top = plan.floor_of(level);
  const double xs[] = {-plan.half.x(), well.min().x(), well.max().x(), plan.half.x()};
  const double ys[] = {-plan.half.y(), -HousePlan::kHallHalf_m, well.min().y(), well.max().y(), plan.half.y()};
  const bool has_well = level > 0 && level < HousePlan::kLevels;
  std::string look;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (has_well && i == 1 && j == 2) continue;
      look = pick_other_than(look, stream, looks);
      writer.box(look, {xs[i], ys[j], top - HousePlan::kSlab_m + kCeiling_m}, {xs[i + 1], ys[j + 1], top});
      writer.box(pick(stream, {"plaster", "plaster_white"}), {xs[i], ys[j], top - HousePlan::kSlab_m},
                 {xs[i + 1], ys[j + 1], top - HousePlan::kSlab_m + kCeiling_m});
    }
  }
}

void add_walls(MjcfWriter& writer, const HousePlan& plan, int level) {
  RandomStream stream(plan.seed, "house/walls" + std::to_string(level));
  const std::vector<std::string> outside =
      level == 0 ? std::vector<std::string>{"concrete_grey", "concrete_dark", "brick_red"}
                 : std::vector<std::string>{"plaster_cream", "brick_pale", "plaster_ochre", "facade_brick"};
  for (const Wall& wall : plan.outer_walls(level)) {
    add_wall(writer, wall, outside, stream);
    for (const Opening& opening : wall.openings) {
      if (opening.sill_m > 0.0) {
        add_window_frame(writer, wall, opening);
      } else {
        add_door_frame(writer, wall, opening);
      }
    }
  }
  const std::vector<std::string> inside =
      level == 0
          ? std::vector<std::string>{"concrete_pale", "brick_pale", "plaster_grey"}
          : std::vector<std::string>{"plaster", "plaster_cream", "plaster_rose", "panels_green", "plaster_white"};
  for (Wall wall : plan.inner_walls(level)) {
    wall.section_m = 4.0;
    add_wall(writer, wall, inside, stream);
    for (const Opening& opening : wall.openings) add_door_frame(writer, wall, opening);
  }
}

void add_stairs(MjcfWriter& writer, const HousePlan& plan) {
  constexpr double kRailIn_m = 0.06;
  const Eigen::AlignedBox2d well = plan.stairwell();
  for (int level = 0; level + 1 < HousePlan::kLevels; ++level) {
    add_flight(writer, "wood_pale", plan.flight(), upright_frame(plan.foot_of_flight(level), 0.0), false, true);
    const double z = plan.floor_of(level + 1);
    const double y = well.min().y() - kRailIn_m;
    add_rail(writer, {well.min().x() - kRailIn_m, y, z}, {well.max().x() - kRailIn_m, y, z});
  }
  const double x = well.min().x() - kRailIn_m;  // where no flight goes on
  const double z = plan.floor_of(HousePlan::kLevels - 1);
  add_rail(writer, {x, well.min().y(), z}, {x, well.max().y() - kRailIn_m, z});
}

void add_roof(MjcfWriter& writer, const HousePlan& plan) {
  const double eaves = plan.floor_of(HousePlan::kLevels);
  const double rise = 0.7 * plan.half.y();
  add_ridged_roof(writer, upright_frame({0.0, 0.0, eaves}, 0.0), plan.outer_half(), rise);
  writer.box("brick_red", {-3.4, -1.6, eaves}, {-2.6, -1.0, eaves + rise + 0.8});
}

SceneDescription build_house(const SceneValues& values, std::uint64_t world_seed) {
  HousePlan plan;
  plan.half = {values.at("length_m") / 2.0, values.at("width_m") / 2.0};
  plan.storey_m = values.at("storey_m");
  plan.furniture = values.at("furniture");
  plan.trees = static_cast<int>(values.at("trees"));
  plan.seed = world_seed;
  MjcfWriter writer;
  for (int level = 0; level < HousePlan::kLevels; ++level) {
    add_slab(writer, plan, level,
             level == 0 ? std::vector<std::string>{"floor_screed", "concrete_grey", "floor_tiles"}
                        : std::vector<std::string>{"wood_floor", "floor_tiles", "carpet_grey", "carpet_blue"});
    add_walls(writer, plan, level);
    furnish_level(writer, plan, level);
  }
  add_slab(writer, plan, HousePlan::kLevels, {"concrete_pale", "concrete_grey"});
  add_stairs(writer, plan);
  add_roof(writer, plan);
  add_garden(writer, plan);
  constexpr double kDusk_lux = 40.0;
  SceneDescription scene = writer.finish("house", scene_palette(), kDusk_lux, kDusk_lux / M_PI);
  scene.routes = plan.routes();
  return scene;
}

}  // namespace

SceneInfo house_scene() {
  return {.name = "house",
          .summary = "furnished house of four levels with stairs, in its garden, lamps lit in the evening",
          .parameters = {{"length_m", 18, 16, 26, "within the outer walls along x"},
                         {"width_m", 12, 11, 16, "along y"},
                         {"storey_m", 2.8, 2.6, 3.4, "from floor to floor"},
                         {"furniture", 0.3, 0, 1, "share of the places along the rooms' walls that are taken"},
                         {"trees", 10, 0, 30, "in the garden", true}},
          .build = build_house};
}

}  // namespace plumbline
