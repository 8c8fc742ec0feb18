#include "sim/scenes/building.h"

#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/open_ground.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/parked_things.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/site_things.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kLawnReachM = 300.0;
constexpr double kParapetM = 0.6;
constexpr double kPavedHalfM = 2.5;  // of the paving around the building, to both sides of the way

struct BuildingPlan {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  double height = 0.0;
  double way = 0.0;
  std::uint64_t seed = 0;

  Eigen::Vector2d way_half() const { return half + Eigen::Vector2d::Constant(way); }
};

/// A side of the building or of a larger rectangle around it: outside of it is to the frame's +y.
struct Side {
  Pose world_from_side;  ///< origin in the middle of the side, x along it
  double length = 0.0;
};

std::vector<Side> sides_of(const Eigen::Vector2d& half) {
  return {{upright_frame({0.0, -half.y(), 0.0}, M_PI), 2.0 * half.x()},
          {upright_frame({half.x(), 0.0, 0.0}, -M_PI / 2.0), 2.0 * half.y()},
          {upright_frame({0.0, half.y(), 0.0}, 0.0), 2.0 * half.x()},
          {upright_frame({-half.x(), 0.0, 0.0}, M_PI / 2.0), 2.0 * half.y()}};
}

// Piers and bands stand out of a wall of glass: what they leave are the windows.
void add_facade(MjcfWriter& writer, const BuildingPlan& plan, const Side& side, const std::string& name) {
  constexpr double kStoreyM = 3.6;
  constexpr double kProudM = 0.2;
  RandomStream stream(plan.seed, name);
  const double half = side.length / 2.0;
  const double top = plan.height + kParapetM;
  const std::vector<double> piers = random_cuts(stream, -half, half, 2.6, 4.4);
  for (const double x : piers) {
    const double pier = stream.uniform(0.25, 0.5);
    writer.box(pick(stream, {"concrete_pale", "brick_red", "brick_pale"}), {x - pier, -0.05, 0.0},
               {x + pier, kProudM + 0.06, top}, side.world_from_side);
  }
  const int storeys = std::max(1, static_cast<int>(std::lround(plan.height / kStoreyM)));
  for (int storey = 0; storey <= storeys; ++storey) {
    const double z = plan.height * storey / storeys;
    const std::vector<double> cuts = random_cuts(stream, -half, half, 5.0, 9.0);
    std::string material;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      material = pick_other_than(material, stream, {"concrete_pale", "concrete_grey", "panels_blue", "panels_white"});
      writer.box(material, {cuts[i - 1], -0.05, storey == 0 ? 0.0 : z - 0.5},
                 {cuts[i], kProudM, storey == storeys ? top : z + 0.7}, side.world_from_side);
    }
  }
}

void add_entrance(MjcfWriter& writer, const Side& south) {
  const Pose& frame = south.world_from_side;
  writer.box("glass", {-1.6, 0.1, 0.0}, {1.6, 0.24, 2.6}, frame);
  for (const double x : {-1.6, 0.0, 1.6}) writer.box("frame_paint", {x - 0.06, 0.1, 0.0}, {x + 0.06, 0.3, 2.6}, frame);
  writer.box("concrete_dark", {-3.0, 0.1, 3.0}, {3.0, 2.6, 3.3}, frame);
  for (const double x : {-2.7, 2.7}) writer.cylinder("steel", {x, 2.3, 0.0}, {x, 2.3, 3.0}, 0.12, frame);
  writer.box("sign_blue", {-2.0, 2.6, 3.05}, {2.0, 2.66, 3.75}, frame);
}

void add_roof_unit(MjcfWriter& writer, RandomStream& stream, const Pose& frame) {
  const double kind = stream.uniform();
  if (kind < 0.4) {  // air handling
    const Eigen::Vector3d half(stream.uniform(0.8, 1.6), stream.uniform(0.6, 1.0), 0.0);
    const double tall = stream.uniform(1.0, 1.8);
    writer.box("panels_grey", -half + Eigen::Vector3d(0, 0, 0.15), half + Eigen::Vector3d(0, 0, tall), frame);
    writer.cylinder("steel", {0.0, 0.0, tall}, {0.0, 0.0, tall + 0.2}, 0.45, frame);
    writer.box("pipe_galvanised", {half.x(), -0.25, 0.3}, {half.x() + 2.2, 0.25, 0.8}, frame);
  } else if (kind < 0.7) {  // skylight
    writer.box("frame_paint", {-1.1, -0.8, 0.0}, {1.1, 0.8, 0.35}, frame);
    writer.box("glass", {-1.0, -0.7, 0.35}, {1.0, 0.7, 0.42}, frame);
  } else if (kind < 0.9) {
    writer.cylinder("pipe_galvanised", {0.0, 0.0, 0.0}, {0.0, 0.0, stream.uniform(0.6, 1.6)}, 0.25, frame);
    writer.cylinder("pipe_galvanised", {0.9, 0.4, 0.0}, {0.9, 0.4, stream.uniform(0.5, 1.0)}, 0.15, frame);
  } else {
    writer.cylinder("steel", {0.0, 0.0, 0.0}, {0.0, 0.0, 3.5}, 0.04, frame);
    writer.box("steel", {-0.3, -0.3, 0.0}, {0.3, 0.3, 0.2}, frame);
  }
}

void add_roof(MjcfWriter& writer, const BuildingPlan& plan) {
  RandomStream stream(plan.seed, "building/roof");
  const double pitch = std::max(6.0, std::sqrt(4.0 * plan.half.x() * plan.half.y()) / 9.0);
  for (double x = -plan.half.x() + 4.0; x <= plan.half.x() - 4.0; x += pitch) {
    for (double y = -plan.half.y() + 4.0; y <= plan.half.y() - 4.0; y += pitch) {
      const Eigen::Vector3d at(x + stream.uniform(-1.2, 1.2), y + stream.uniform(-1.2, 1.2), plan.height);
      const Pose frame = upright_frame(at, stream.integer(0, 3) * M_PI / 2.0 + stream.uniform(-0.1, 0.1));
      if (stream.uniform() < 0.8) add_roof_unit(writer, stream, frame);
    }
  }
}

// The body of the house, in stretches whose roofs differ.
void add_core(MjcfWriter& writer, const BuildingPlan& plan) {
  RandomStream stream(plan.seed, "building/core");
  const std::vector<double> cuts = random_cuts(stream, -plan.half.x(), plan.half.x(), 6.0, 12.0);
  std::string roof;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    writer.box("glass", {cuts[i - 1], -plan.half.y(), 0.0}, {cuts[i], plan.half.y(), plan.height - 0.3});
    roof = pick_other_than(roof, stream, {"roof_felt", "gravel_path", "concrete_dark"});
    writer.box(roof, {cuts[i - 1], -plan.half.y(), plan.height - 0.3}, {cuts[i], plan.half.y(), plan.height});
  }
}

void add_ground(MjcfWriter& writer, const BuildingPlan& plan) {
  RandomStream stream(plan.seed, "building/ground");
  const std::vector<std::string> paving = {"asphalt_worn", "gravel_path", "floor_tiles", "concrete_dark"};
  const std::vector<std::string> lawn = {"lawn_short", "lawn_short", "gravel_path"};
  const Eigen::Vector2d inner = plan.half;
  const Eigen::Vector2d outer = plan.way_half() + Eigen::Vector2d::Constant(kPavedHalfM);
  add_patches(writer, stream, {-outer.x(), -outer.y()}, {outer.x(), -inner.y()}, paving);
  add_patches(writer, stream, {-outer.x(), inner.y()}, {outer.x(), outer.y()}, paving);
  add_patches(writer, stream, {-outer.x(), -inner.y()}, {-inner.x(), inner.y()}, paving);
  add_patches(writer, stream, {inner.x(), -inner.y()}, {outer.x(), inner.y()}, paving);
  writer.box("lawn_short", {-kLawnReachM, -kLawnReachM, -1.0}, {kLawnReachM, -outer.y(), 0.0});
  writer.box("lawn_short", {-kLawnReachM, outer.y(), -1.0}, {kLawnReachM, kLawnReachM, 0.0});
  writer.box("lawn_short", {-kLawnReachM, -outer.y(), -1.0}, {-outer.x(), outer.y(), 0.0});
  writer.box("lawn_short", {outer.x(), -outer.y(), -1.0}, {kLawnReachM, outer.y(), 0.0});
}

// Outside the way: trees, lamp posts, benches, parked things; beyond them other houses.
void add_surroundings(MjcfWriter& writer, const BuildingPlan& plan, const Side& side, const std::string& name) {
  RandomStream stream(plan.seed, name);
  const double half = side.length / 2.0;
  for (double x = -half; x < half; x += stream.uniform(5.0, 9.0)) {
    const double out = kPavedHalfM + stream.uniform(0.7, 1.5);
    const double kind = stream.uniform();
    const auto place = [&](double y) { return side.world_from_side * upright_frame({x, y, 0.0}, 0.0); };
    if (kind < 0.35) {
      add_site_tree(writer, stream, place(out + 3.0), stream.uniform(5.0, 9.0));
    } else if (kind < 0.55) {
      add_lamp_post(writer, place(out) * upright_frame(Eigen::Vector3d::Zero(), M_PI), 400.0);
    } else if (kind < 0.7) {
      add_bench(writer, place(out) * upright_frame(Eigen::Vector3d::Zero(), M_PI));
    } else {
      add_parked_thing(writer, stream, place(out + 3.5) * upright_frame(Eigen::Vector3d::Zero(), M_PI / 2.0));
    }
  }
  for (double x = -half - 10.0; x < half; x += stream.uniform(22.0, 34.0)) {
    const Eigen::Vector3d size(stream.uniform(10.0, 18.0), stream.uniform(8.0, 12.0), stream.uniform(4.0, 9.0));
    const Eigen::Vector3d at(x + size.x() / 2.0, stream.uniform(28.0, 45.0), 0.0);
    add_plain_house(writer, stream, side.world_from_side * upright_frame(at, stream.uniform(-0.3, 0.3)), size);
  }
}

Route flight_over(const BuildingPlan& plan) {
  constexpr double kAboveRoofM = 5.0;
  constexpr double kStartM = 1.0;
  const double x = 0.415 * 2.0 * plan.half.x();
  const double y = 2.0 / 3.0 * plan.half.y();
  const double z = plan.height + kAboveRoofM;
  const double pad = -plan.half.y() - plan.way;
  return make_route("over_the_roof",
                    {{0.0, pad, kStartM},
                     {0.0, pad, z},
                     {-x, -y, z},
                     {x, -y, z},
                     {x, 0.0, z},
                     {-x, 0.0, z},
                     {-x, y, z},
                     {x, y, z},
                     {0.0, pad, z},
                     {0.0, pad, kStartM}},
                    1.0);
}

SceneDescription build_building(const SceneValues& values, std::uint64_t world_seed) {
  const BuildingPlan plan{.half = {values.at("length_m") / 2.0, values.at("width_m") / 2.0},
                          .height = values.at("height_m"),
                          .way = values.at("way_m"),
                          .seed = world_seed};
  MjcfWriter writer;
  add_ground(writer, plan);
  add_core(writer, plan);
  add_roof(writer, plan);
  const std::vector<Side> walls = sides_of(plan.half);
  const std::vector<Side> ways = sides_of(plan.way_half());
  for (std::size_t i = 0; i < walls.size(); ++i) {
    add_facade(writer, plan, walls[i], "building/facade" + std::to_string(i));
    add_surroundings(writer, plan, ways[i], "building/surroundings" + std::to_string(i));
  }
  add_entrance(writer, walls[0]);
  SceneDescription scene = writer.finish("building", scene_palette(), 0.0, 0.0);
  light_by_day(scene);
  scene.routes = {rectangular_route("around", Eigen::Vector3d::Zero(), plan.way_half(), 3.0), flown(flight_over(plan))};
  return scene;
}

}  // namespace

SceneInfo building_scene() {
  return {.name = "building",
          .summary = "office building to walk around, with a roof to fly over",
          .parameters = {{"length_m", 60, 30, 300, "of the building along x"},
                         {"width_m", 30, 20, 160, "along y; with 300 m by 125 m the way around is 910 m long"},
                         {"height_m", 12, 7, 24, "of the roof"},
                         {"way_m", 8, 5, 15, "from the walls to the way around"}},
          .build = build_building,
          .usual_lux = kDaylightLux};
}

}  // namespace plumbline
