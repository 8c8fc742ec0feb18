#include "sim/scenes/bridge.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/scenes/foliage.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSpan_m = 24.0;  // from pier to pier
constexpr double kPierHalf_m = 1.6;
constexpr double kDeckHalf_m = 4.2;  // across, along y
constexpr double kRoadHalf_m = 3.4;
constexpr double kReach_m = 100.0;  // of the ground, both ways

double ease(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The valley follows the river, which swings a little; under the bridge the bed is level.
Terrain valley_ground(double depth, std::uint64_t seed) {
  Terrain ground;
  ground.low = {-kReach_m, -kReach_m};
  ground.high = {kReach_m, kReach_m};
  ground.cell_m = 2.0;
  ground.height = [=](double x, double y) {
    const double away = ease((std::abs(y) - 8.0) / 30.0);
    const double swing = 7.0 * away * smooth_noise(seed, 0.3, y / 55.0);
    const double off = std::abs(x - swing);
    const double bank = ease((off - 34.0) / 22.0);
    const double rough =
        away * (1.6 * smooth_noise(seed + 1, x / 19.0, y / 19.0)) + 0.18 * smooth_noise(seed + 2, x / 4.0, y / 4.0);
    const double near_road = std::abs(y) < 10.0 ? std::clamp((off - 50.0) / 6.0, 0.0, 1.0) : 0.0;
    const double channel = -1.2 * ease((9.0 - off) / 5.0);
    return -depth * (1.0 - bank) + channel + (1.0 - near_road) * rough - 0.08;
  };
  ground.material = [=](double x, double y) -> std::string {
    if (std::abs(y) < kRoadHalf_m && std::abs(x) > 54.0) return "asphalt";
    const double noise = smooth_noise(seed + 3, x / 8.0, y / 8.0);
    if (std::abs(x) < 18.0) return noise > 0.0 ? "gravel" : "rock";
    return noise > 0.4 ? "field" : (noise > -0.3 ? "grass" : "grass_dry");
  };
  return ground;
}

/// Height of the arches' undersides; piers are solid to the ground.
double underside(double x, double depth) {
  const double in_span = std::remainder(x, kSpan_m);
  const double half = 0.5 * kSpan_m - kPierHalf_m;
  if (std::abs(in_span) >= half || std::abs(x) > 1.5 * kSpan_m - kPierHalf_m) return -depth - 3.0;
  const double spring = -depth + 2.5;
  const double crown = -1.3;
  return spring + (crown - spring) * std::sqrt(1.0 - std::pow(in_span / half, 2.0));
}

void add_arches(Scenery& scenery, RandomStream& stream, double depth) {
  constexpr double kSlice_m = 0.6;
  const double reach = 1.5 * kSpan_m + 20.0;  // the ends stand in the banks
  const int slices = static_cast<int>(std::lround(2.0 * reach / kSlice_m));
  for (int i = 0; i < slices; ++i) {
    const double x0 = -reach + 2.0 * reach * i / slices;
    const double x1 = -reach + 2.0 * reach * (i + 1) / slices;
    const char* material = stream.uniform() < 0.75 ? "stone_dark" : "brick_pale";
    scenery.prism(material,
                  {{x0, underside(x0 + 1e-6, depth)}, {x1, underside(x1 - 1e-6, depth)}, {x1, -0.02}, {x0, -0.02}},
                  -kDeckHalf_m, kDeckHalf_m);
  }
  // Cutwaters and pilasters on the piers, a cornice under the parapets.
  for (int pier = -1; pier <= 2; ++pier) {
    const double x = (pier - 0.5) * kSpan_m;
    for (const double side : {-1.0, 1.0}) {
      const double y0 = std::min(side * kDeckHalf_m, side * (kDeckHalf_m + 1.1));
      scenery.block("stone_pale", {x - 1.0, y0, -depth - 3.0}, {x + 1.0, y0 + 1.1, -depth + 4.0}, {});
      const double p0 = std::min(side * kDeckHalf_m, side * (kDeckHalf_m + 0.35));
      scenery.block("stone_pale", {x - 0.8, p0, -depth}, {x + 0.8, p0 + 0.35, 0.0}, {});
    }
  }
  for (const double side : {-1.0, 1.0}) {
    const double y0 = std::min(side * kDeckHalf_m, side * (kDeckHalf_m + 0.2));
    scenery.box("stone_pale", {-reach, y0, -0.35}, {reach, y0 + 0.2, 0.0}, {});
    const double p0 = std::min(side * (kDeckHalf_m - 0.35), side * kDeckHalf_m);
    for (double x = -reach; x < reach - 3.0; x += 6.0) {
      scenery.block(stream.uniform() < 0.5 ? "stone_dark" : "stone_pale", {x, p0, 0.0},
                    {x + 6.0, p0 + 0.35, stream.uniform(0.9, 1.05)});
    }
    const double w0 = std::min(side * kRoadHalf_m, side * (kDeckHalf_m - 0.35));
    scenery.block("paving", {-reach, w0, -0.02}, {reach, w0 + (kDeckHalf_m - 0.35 - kRoadHalf_m), 0.13});
  }
  for (double x = -reach; x < reach - 0.1; x += 4.0) {
    scenery.quad(stream.uniform() < 0.7 ? "asphalt" : "asphalt_worn", {x, -kRoadHalf_m, 0.0},
                 {x + 4.0, -kRoadHalf_m, 0.0}, {x + 4.0, kRoadHalf_m, 0.0}, {x, kRoadHalf_m, 0.0});
  }
}

void add_banks(Outdoors& outdoors, const Terrain& ground, double depth, double density, std::uint64_t seed) {
  RandomStream stream(seed, "bridge/banks");
  const auto on_ground = [&](double x, double y) { return Vector3d(x, y, height_on(ground, x, y)); };
  for (int i = 0; i < 130; ++i) {
    const double x = (stream.uniform() < 0.5 ? -1.0 : 1.0) * stream.uniform(42.0, 96.0);
    const double y = (stream.uniform() < 0.5 ? -1.0 : 1.0) * stream.uniform(11.0, 96.0);
    const Tree tree = draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), density);
    add_tree(outdoors.scenery, stream, on_ground(x, y), tree);
  }
  for (int i = 0; i < 260; ++i) {
    const double x = (stream.uniform() < 0.5 ? -1.0 : 1.0) * stream.uniform(8.0, 46.0);
    const double y = stream.uniform(-94.0, 94.0);
    if (std::abs(y) < 7.0 && std::abs(x) < 40.0) continue;
    if (stream.uniform() < 0.5) {
      add_rock(outdoors.scenery, stream, on_ground(x, y), stream.uniform(0.3, 1.3));
    } else {
      add_bush(outdoors.scenery, stream, on_ground(x, y), stream.uniform(0.5, 1.2), stream.uniform(0.5, 1.6), 50);
    }
  }
  outdoors.scenery.quad("water", {-30.0, -kReach_m, -depth - 0.45}, {30.0, -kReach_m, -depth - 0.45},
                        {30.0, kReach_m, -depth - 0.45}, {-30.0, kReach_m, -depth - 0.45});
  for (double x = -48.0; x <= 48.0; x += 16.0) {
    const double side = std::lround(x / 16.0) % 2 == 0 ? 1.0 : -1.0;
    const Pose foot = upright_frame({x + stream.uniform(-2.0, 2.0), side * (kRoadHalf_m + 0.3), 0.1},
                                    side > 0.0 ? 0.0 : std::numbers::pi);
    outdoors.geoms.lamp({add_street_lamp(outdoors.scenery, foot, 5.5, 1.0), 900.0, 26.0});
  }
  for (const double x : {-12.0, 12.0}) {  // floodlights at the piers' feet
    for (const double y : {-7.5, 7.5}) {
      const Pose foot = upright_frame(on_ground(x, y), 0.0);
      outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot, 1.2), 700.0, 25.0});
    }
  }
}

/// Along the river, under one arch and back under the next.
Route flight_of(double depth) {
  Route flight{.name = "flight", .points = {}, .closed = true, .flown = true};
  const double reach = 45.0;
  const double turn = 0.5 * kSpan_m;
  const double low = -depth + 4.0;
  const auto add = [&](double x, double y) {
    const double rise = 2.0 * ease((std::abs(y) - 12.0) / 25.0);
    flight.points.emplace_back(x, y, low + rise);
  };
  for (double y = -reach; y < reach; y += 3.0) add(0.0, y);
  for (int i = 0; i < 14; ++i) {
    const double angle = std::numbers::pi * i / 14.0;
    add(turn - turn * std::cos(angle), reach + turn * std::sin(angle));
  }
  for (double y = reach; y > -reach; y -= 3.0) add(kSpan_m, y);
  for (int i = 0; i < 14; ++i) {
    const double angle = std::numbers::pi * i / 14.0;
    add(turn + turn * std::cos(angle), -reach - turn * std::sin(angle));
  }
  return flight;
}

SceneDescription build_bridge(const SceneValues& values, std::uint64_t world_seed) {
  const double depth = values.at("valley_depth_m");
  const Terrain ground = valley_ground(depth, derive_seed(world_seed, "bridge/land"));
  Outdoors outdoors;
  add_ground(outdoors.scenery, ground);
  RandomStream stone(world_seed, "bridge/stone");
  add_arches(outdoors.scenery, stone, depth);
  add_banks(outdoors, ground, depth, values.at("leaf_density"), world_seed);
  outdoors.routes.push_back(flight_of(depth));
  Route crossing{.name = "crossing", .points = {}, .closed = false};
  for (double x = -52.0; x <= 52.0; x += 4.0) crossing.points.emplace_back(x, -1.7, 0.0);
  outdoors.routes.push_back(std::move(crossing));
  return finish_outdoors("bridge", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo bridge_scene() {
  return {.name = "bridge",
          .summary = "stone bridge of three arches over a river, to fly under",
          .parameters = {{"valley_depth_m", 12, 9, 18, "of the river's bed below the bridge's road"},
                         {"leaf_density", 1, 0.3, 4, "sprays of leaves on every tree; 1: some 450"},
                         night_parameter()},
          .build = build_bridge,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
