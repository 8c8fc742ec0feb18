#include "sim/scenes/lawn.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/scenes/foliage.h"
#include "sim/scenes/houses.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLawnReach_m = 120.0;
constexpr double kTour_m = 86.0;

Terrain lawn_ground(std::uint64_t seed) {
  Terrain ground;
  ground.low = {-kLawnReach_m, -kLawnReach_m};
  ground.high = {kLawnReach_m, kLawnReach_m};
  ground.cell_m = 2.0;
  ground.height = [seed](double x, double y) {
    const double away = std::clamp((std::hypot(x, y) - 40.0) / 60.0, 0.0, 1.0);
    return 0.02 * smooth_noise(seed, x / 5.0, y / 5.0) + away * 2.0 * smooth_noise(seed + 1, x / 45.0, y / 45.0);
  };
  ground.material = [seed](double x, double y) -> std::string {
    return smooth_noise(seed + 2, x / 7.0, y / 7.0) > 0.45 ? "grass_dry" : "grass";
  };
  return ground;
}

/// A place at a bearing outside the open quarter towards +x, at least clear_m from the middle.
Vector2d draw_place(RandomStream& stream, double clear_m, double beyond_m) {
  const double bearing = stream.uniform(0.3 * std::numbers::pi, 1.7 * std::numbers::pi);
  const double reach = clear_m + stream.uniform(0.0, beyond_m);
  return {reach * std::cos(bearing), reach * std::sin(bearing)};
}

void add_surroundings(Outdoors& outdoors, const Terrain& ground, double clear_m, std::uint64_t seed) {
  RandomStream stream(seed, "lawn/surroundings");
  const auto on_ground = [&](const Vector2d& p) { return Vector3d(p.x(), p.y(), height_on(ground, p.x(), p.y())); };
  constexpr double kCrown_m = 4.5;  // of the largest tree, with its sprays
  for (int i = 0; i < 60; ++i) {
    const Vector3d foot = on_ground(draw_place(stream, clear_m + kCrown_m, 45.0));
    add_tree(outdoors.scenery, stream, foot, draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), 1.0));
  }
  for (int i = 0; i < 40; ++i) {
    const Vector3d foot = on_ground(draw_place(stream, clear_m + 2.0, 40.0));
    add_bush(outdoors.scenery, stream, foot, stream.uniform(0.5, 1.2), stream.uniform(0.6, 1.8), 60);
  }
  for (int i = 0; i < 6; ++i) {
    const double bearing = (0.4 + 0.24 * i + stream.uniform(0.0, 0.08)) * std::numbers::pi;
    const double reach = clear_m + 18.0 + stream.uniform(0.0, 12.0);
    const Vector2d place(reach * std::cos(bearing), reach * std::sin(bearing));
    // The front looks at the lawn: its y axis points away from the middle.
    add_house(outdoors.scenery, stream, upright_frame(on_ground(place), bearing - 0.5 * std::numbers::pi),
              draw_villa(stream));
  }
  for (int i = 0; i < 8; ++i) {
    const double bearing = 2.0 * std::numbers::pi * (i + stream.uniform(0.0, 0.5)) / 8.0;
    const Vector2d place = (clear_m + 1.0) * Vector2d(std::cos(bearing), std::sin(bearing));
    const Pose foot = upright_frame(on_ground(place), bearing);
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot, 7.0), 3000.0, 70.0});
  }
}

/// Two half circles and two straights, as long as promised.
Route tour_of(const Terrain& ground) {
  constexpr double kTurn_m = 7.0;
  const double straight = 0.5 * (kTour_m - 2.0 * std::numbers::pi * kTurn_m);
  Route tour{.name = "tour", .points = {}, .closed = true};
  const auto add = [&](double x, double y) { tour.points.emplace_back(x, y, height_on(ground, x, y)); };
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps; ++i) add(-0.5 * straight + straight * i / kSteps, -kTurn_m);
  for (int i = 0; i < kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    add(0.5 * straight + kTurn_m * std::sin(angle), -kTurn_m * std::cos(angle));
  }
  for (int i = 0; i < kSteps; ++i) add(0.5 * straight - straight * i / kSteps, kTurn_m);
  for (int i = 0; i < kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    add(-0.5 * straight - kTurn_m * std::sin(angle), kTurn_m * std::cos(angle));
  }
  return tour;
}

SceneDescription build_lawn(const SceneValues& values, std::uint64_t world_seed) {
  const Terrain ground = lawn_ground(derive_seed(world_seed, "lawn/land"));
  Outdoors outdoors;
  add_ground(outdoors.scenery, ground);
  RandomStream stream(world_seed, "lawn/grass");
  const int tufts = static_cast<int>(values.at("tufts"));
  for (int i = 0; i < tufts; ++i) {
    const double x = stream.uniform(-30.0, 30.0);
    const double y = stream.uniform(-30.0, 30.0);
    add_grass_tuft(outdoors.scenery, stream, {x, y, height_on(ground, x, y)}, stream.uniform(0.03, 0.09), 4,
                   stream.uniform() < 0.7 ? "grass" : "grass_dry");
  }
  add_surroundings(outdoors, ground, values.at("clear_m"), world_seed);
  outdoors.routes.push_back(tour_of(ground));
  return finish_outdoors("lawn", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo lawn_scene() {
  return {.name = "lawn",
          .summary = "flat lawn with nothing near by",
          .parameters = {{"clear_m", 32, 20, 60, "radius without anything but grass"},
                         {"tufts", 2500, 0, 10000, "of grass on the middle 60 m x 60 m", true},
                         night_parameter()},
          .build = build_lawn,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
