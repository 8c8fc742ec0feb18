#include "sim/scenes/shed_site.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "sim/scenes/foliage.h"
#include "sim/scenes/houses.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kShedLength_m = 30.0;
constexpr double kShedHalfWidth_m = 7.0;
constexpr double kEaves_m = 5.0;
constexpr double kGateHalf_m = 4.0;
constexpr double kGate_m = 4.4;
constexpr double kSecondShed_m = 100.0;  // x where the second shed begins
constexpr double kTreeLine_m = 46.0;     // y between its two rows
constexpr double kGap_m = 588.0;         // x of a gap in the right row, to fly in by

Terrain site_ground(double tree_line_m, std::uint64_t seed) {
  Terrain ground;
  ground.cell_m = 4.0;
  ground.low = {-80.0, -80.0};
  ground.high = {std::ceil((tree_line_m + 180.0) / 4.0) * 4.0, 120.0};
  ground.height = [seed](double x, double y) {
    // Level where the sheds stand.
    const double from_sheds = std::max(std::abs(x - 65.0) - 75.0, std::abs(y) - 16.0);
    const double away = std::clamp(from_sheds / 30.0, 0.0, 1.0);
    return away * (0.9 * smooth_noise(seed, x / 60.0, y / 60.0) + 0.12 * smooth_noise(seed + 1, x / 9.0, y / 9.0));
  };
  ground.material = [seed](double x, double y) -> std::string {
    const double noise = smooth_noise(seed + 2, x / 14.0, y / 14.0);
    const bool yard = std::abs(x - 65.0) < 74.0 && std::abs(y) < 14.0;
    if (yard) return noise > 0.1 ? "gravel" : "concrete_dark";
    return noise > 0.35 ? "field" : (noise > -0.25 ? "grass" : "grass_dry");
  };
  return ground;
}

/// Walls, a roof on trusses, and gates at both ends that one can fly through.
void add_shed(Scenery& scenery, RandomStream& stream, double x0) {
  const double x1 = x0 + kShedLength_m;
  const double w = kShedHalfWidth_m;
  const std::string wall = pick(stream, cladding_materials());
  for (const double side : {-1.0, 1.0}) {
    const double y0 = std::min(side * w, side * (w - 0.15));
    scenery.block(wall, {x0, y0, -0.5}, {x1, y0 + 0.15, kEaves_m});
    for (double x = x0 + stream.uniform(1.0, 3.0); x + 3.0 < x1; x += stream.uniform(3.5, 6.0)) {
      const double p0 = std::min(side * (w - 0.2), side * (w + 0.05));
      scenery.box("frame_white", {x, p0, 1.6}, {x + 1.6, p0 + 0.25, 2.9});
      scenery.box("glass", {x + 0.1, p0 - 0.01, 1.7}, {x + 1.5, p0 + 0.26, 2.8});
    }
    // Stores along the walls.
    for (double x = x0 + stream.uniform(1.0, 2.0); x + 2.0 < x1; x += stream.uniform(1.8, 4.5)) {
      if (stream.uniform() < 0.35) continue;
      const double size = stream.uniform(0.3, 0.6);
      const double y = side * (w - 0.4 - size);
      scenery.block(pick(stream, crate_materials()), {x - size, y - size, -0.1},
                    {x + size, y + size, 2.0 * size * stream.uniform(0.7, 1.6)});
    }
  }
  const double ridge = kEaves_m + 0.25 * w;
  for (const double x : {x0, x1 - 0.15}) {  // the ends, around their gates
    scenery.block(wall, {x, -w, -0.5}, {x + 0.15, -kGateHalf_m, kEaves_m});
    scenery.block(wall, {x, kGateHalf_m, -0.5}, {x + 0.15, w, kEaves_m});
    scenery.box(wall, {x, -kGateHalf_m, kGate_m}, {x + 0.15, kGateHalf_m, kEaves_m});
    const Pose across = upright_frame({x + 0.15, 0.0, 0.0}, 0.5 * std::numbers::pi);
    scenery.prism(wall, {{-w, kEaves_m}, {w, kEaves_m}, {0.0, ridge}}, 0.0, 0.15, across);
  }
  for (double x = x0; x <= x1; x += 5.0) {  // frames
    for (const double side : {-1.0, 1.0}) {
      const double y0 = std::min(side * (w - 0.15), side * (w - 0.4));
      scenery.block("steel", {x - 0.12, y0, -0.2}, {x + 0.12, y0 + 0.25, kEaves_m});
      scenery.rod("steel", {x, side * (w - 0.2), kEaves_m}, {x, 0.0, ridge - 0.1}, 0.09, 0.09, 5);
    }
    scenery.rod("steel", {x, -w + 0.2, kEaves_m - 0.15}, {x, w - 0.2, kEaves_m - 0.15}, 0.08, 0.08, 5);
  }
  for (const double side : {-1.0, 1.0}) {
    const Vector3d eave0(x0 - 0.4, side * (w + 0.5), kEaves_m - 0.1);
    const Vector3d eave1(x1 + 0.4, side * (w + 0.5), kEaves_m - 0.1);
    scenery.sheet("roof_metal", eave0, eave1, {x1 + 0.4, 0.0, ridge + 0.05}, {x0 - 0.4, 0.0, ridge + 0.05});
  }
}

void add_tree_line(Scenery& scenery, const Terrain& ground, double length_m, double density, std::uint64_t seed) {
  for (const double row : {-4.5, 4.5}) {
    RandomStream stream(seed, row > 0.0 ? "shed site/trees/left" : "shed site/trees/right");
    for (double x = 40.0 + stream.uniform(0.0, 6.0); x < 40.0 + length_m; x += stream.uniform(6.0, 12.0)) {
      if (row < 0.0 && std::abs(x - kGap_m) < 18.0) continue;
      const auto species = stream.uniform() < 0.75 ? Species::kLinden : Species::kBirch;
      Tree tree = draw_tree(stream, species, density);
      tree.bole_m = stream.uniform(3.8, 4.4);  // crowns meet above a flight at 2 m
      tree.height_m = std::max(tree.height_m + 2.0, tree.bole_m + 4.0);
      tree.crown_radius_m = std::min(tree.crown_radius_m + 1.2, 4.4);
      const double y = kTreeLine_m + row + stream.uniform(-0.7, 0.7);
      add_tree(scenery, stream, {x, y, height_on(ground, x, y)}, tree);
      if (stream.uniform() < 0.5) {
        const double out = kTreeLine_m + std::copysign(stream.uniform(6.5, 10.0), row);
        add_bush(scenery, stream, {x + 2.0, out, height_on(ground, x + 2.0, out)}, stream.uniform(0.5, 1.3),
                 stream.uniform(0.6, 1.8), 45);
      }
      for (int i = 0; i < 3; ++i) {
        const double u = x + stream.uniform(-4.0, 4.0);
        const double v = kTreeLine_m + stream.uniform(-9.0, 9.0);
        add_grass_tuft(scenery, stream, {u, v, height_on(ground, u, v)}, stream.uniform(0.1, 0.4), 5, "grass_dry");
      }
    }
  }
}

void add_yard(Outdoors& outdoors, const Terrain& ground, double length_m, std::uint64_t seed) {
  RandomStream stream(seed, "shed site/yard");
  const auto on_ground = [&](double x, double y) { return Vector3d(x, y, height_on(ground, x, y)); };
  for (int i = 0; i < 26; ++i) {  // stores beside the way between the sheds
    const double x = stream.uniform(-15.0, 145.0);
    const double y = (stream.uniform() < 0.5 ? -1.0 : 1.0) * stream.uniform(8.8, 11.5);
    const double size = stream.uniform(0.3, 0.8);
    outdoors.scenery.block(pick(stream, crate_materials()), {-size, -size, -0.3}, {size, size, 2.0 * size},
                           upright_frame(on_ground(x, y), stream.uniform(0.0, 1.5)));
  }
  for (double x = -60.0; x + 10.0 < 180.0; x += 10.0) {
    add_fence(outdoors.scenery, stream, on_ground(x, -45.0), on_ground(x + 10.0, -45.0), Fence::kMesh);
  }
  for (int i = 0; i < 5; ++i) {
    const Pose frame = upright_frame(on_ground(-50.0 + 52.0 * i + stream.uniform(-8.0, 8.0), -52.0), std::numbers::pi);
    add_house(outdoors.scenery, stream, frame, draw_villa(stream));
  }
  for (double x = -40.0; x < length_m; x += stream.uniform(45.0, 80.0)) {
    if (x > 26.0 && x < 40.0) continue;  // the tree mission takes off here
    const Pose foot = upright_frame(on_ground(x, 30.5), 0.0);
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot, 8.0), 2500.0, 45.0});
  }
  for (const double x : {5.0, 15.0, 25.0, 105.0, 115.0, 125.0}) {
    outdoors.geoms.lamp({{x, 0.0, kEaves_m - 0.5}, 350.0, 14.0});
  }
}

/// Points at most 4 m apart through way-points, each by its height above the ground.
Route route_through(const std::string& name, const Terrain& ground, const std::vector<Vector3d>& corners, bool closed) {
  Route route{.name = name, .points = {}, .closed = closed};
  const std::size_t legs = closed ? corners.size() : corners.size() - 1;
  for (std::size_t i = 0; i < legs; ++i) {
    const Vector3d& a = corners[i];
    const Vector3d along = corners[(i + 1) % corners.size()] - a;
    const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / 4.0)));
    const bool last = !closed && i + 1 == legs;
    for (int k = 0; k < steps + (last ? 1 : 0); ++k) {
      Vector3d point = a + along * k / steps;
      point.z() += height_on(ground, point.x(), point.y());
      route.points.push_back(point);
    }
  }
  return route;
}

/// A closed way's right-angled corners as arcs of 5 m: a utility vehicle needs 3.4 m.
std::vector<Vector3d> with_round_corners(const std::vector<Vector3d>& corners) {
  constexpr double kRadius_m = 5.0;
  constexpr int kSteps = 5;
  std::vector<Vector3d> round;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d& corner = corners[i];
    const Vector3d back = (corners[(i + corners.size() - 1) % corners.size()] - corner).normalized();
    const Vector3d on = (corners[(i + 1) % corners.size()] - corner).normalized();
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = 0.5 * std::numbers::pi * k / kSteps;
      round.push_back(corner + kRadius_m * ((1.0 - std::cos(angle)) * on + (1.0 - std::sin(angle)) * back));
    }
  }
  return round;
}

void add_routes(Outdoors& outdoors, const Terrain& ground) {
  std::vector<Route>& routes = outdoors.routes;
  const double far = kSecondShed_m + kShedLength_m;
  // Through both sheds, around the second, and round the whole yard.
  routes.push_back(route_through("walk", ground,
                                 with_round_corners({{-20.0, 0.0, 0.0},
                                                     {far + 20.0, 0.0, 0.0},
                                                     {far + 20.0, 20.0, 0.0},
                                                     {-24.0, 20.0, 0.0},
                                                     {-24.0, -25.0, 0.0},
                                                     {100.0, -25.0, 0.0},
                                                     {100.0, -14.0, 0.0},
                                                     {-20.0, -14.0, 0.0}}),
                                 true));
  constexpr double kLow_m = 2.0;
  routes.push_back(flown(route_through("shed_mission", ground,
                                       {{15.0, 0.0, 1.2},
                                        {15.0, 0.0, kLow_m},
                                        {50.0, 0.0, kLow_m},
                                        {70.0, 0.0, 3.0},
                                        {90.0, 0.0, kLow_m},
                                        {far + 18.2, 0.0, kLow_m},
                                        {far + 30.2, 14.0, 5.0},
                                        {far + 18.2, 26.0, 8.0},
                                        {-10.0, 26.0, 8.0},
                                        {-22.0, 12.0, 4.0},
                                        {-14.0, 0.0, kLow_m},
                                        {13.5, 0.0, kLow_m},
                                        {13.5, 0.0, 1.2}},
                                       false)));
  constexpr double kTurn_m = kGap_m - 18.0;
  routes.push_back(flown(route_through("tree_mission", ground,
                                       {{30.0, 30.0, 1.2},
                                        {40.0, 30.0, 20.0},
                                        {kTurn_m, 30.0, 20.0},
                                        {kTurn_m + 18.0, 34.0, 14.0},
                                        {kTurn_m + 20.0, kTreeLine_m, kLow_m},
                                        {60.0, kTreeLine_m, kLow_m}},
                                       false)));
  routes.push_back(route_through(
      "drive", ground,
      with_round_corners({{-10.0, 34.0, 0.0}, {711.8, 34.0, 0.0}, {711.8, 20.0, 0.0}, {-10.0, 20.0, 0.0}}), true));
}

SceneDescription build_shed_site(const SceneValues& values, std::uint64_t world_seed) {
  const double tree_line = values.at("tree_line_m");
  const Terrain ground = site_ground(tree_line, derive_seed(world_seed, "shed site/land"));
  Outdoors outdoors;
  add_ground(outdoors.scenery, ground);
  RandomStream sheds(world_seed, "shed site/sheds");
  add_shed(outdoors.scenery, sheds, 0.0);
  add_shed(outdoors.scenery, sheds, kSecondShed_m);
  add_tree_line(outdoors.scenery, ground, tree_line, values.at("leaf_density"), world_seed);
  add_yard(outdoors, ground, tree_line, world_seed);
  add_routes(outdoors, ground);
  return finish_outdoors("shed_site", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo shed_site_scene() {
  return {.name = "shed_site",
          .summary = "two open sheds, a line of trees to fly beneath, open ground",
          .parameters = {{"tree_line_m", 1000, 600, 1500, "length of the line of trees"},
                         {"leaf_density", 1, 0.3, 4, "sprays of leaves on every tree; 1: some 450"},
                         night_parameter()},
          .build = build_shed_site,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
