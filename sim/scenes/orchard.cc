#include "sim/scenes/orchard.h"

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

using Eigen::Vector3d;

constexpr double kRowSpacing_m = 5.0;
constexpr double kHeadland_m = 9.0;
constexpr double kSurround_m = 45.0;

Terrain orchard_ground(double half_length, double half_width, std::uint64_t seed) {
  Terrain ground;
  ground.cell_m = 1.25;
  const auto cells = [&](double half) { return std::ceil(half / ground.cell_m) * ground.cell_m; };
  ground.low = {-cells(half_length + kSurround_m), -cells(half_width + kSurround_m)};
  ground.high = -ground.low;
  ground.height = [seed](double x, double y) {
    return 1.2 * smooth_noise(seed, x / 40.0, y / 40.0) + 0.04 * smooth_noise(seed + 1, x / 2.2, y / 2.2);
  };
  ground.material = [=](double x, double y) -> std::string {
    const bool inside = std::abs(x) < half_length && std::abs(y) < half_width;
    const double noise = smooth_noise(seed + 2, x / 6.0, y / 6.0);
    if (!inside) return noise > 0.35 ? "grass_dry" : "grass";
    // The soil under the trees is kept bare.
    const double off = std::abs(std::remainder(y - 0.5 * kRowSpacing_m, kRowSpacing_m));
    if (off < 0.9) return noise > -0.2 ? "field" : "grass_dry";
    return noise > 0.5 ? "grass_dry" : "grass";
  };
  return ground;
}

void add_row(Scenery& scenery, const Terrain& ground, double half_length, double y, double density,
             std::uint64_t seed) {
  RandomStream stream(seed, "orchard/row " + std::to_string(std::lround(2.0 * y)));
  for (double x = -half_length + stream.uniform(0.0, 1.0); x < half_length; x += stream.uniform(2.6, 3.9)) {
    if (stream.uniform() < 0.05) continue;  // a gap
    Tree tree = draw_tree(stream, Species::kFruit, 1.5 * density);
    tree.crown_radius_m = std::min(tree.crown_radius_m, 1.2);
    const double off = y + stream.uniform(-0.12, 0.12);
    const Vector3d foot(x, off, height_on(ground, x, off));
    add_tree(scenery, stream, foot, tree);
    if (stream.uniform() < 0.4) {
      scenery.rod("crate_wood", foot + Vector3d(0.25, 0.0, -0.3), foot + Vector3d(0.25, 0.0, 1.8), 0.04, 0.04, 5);
    }
    for (int i = 0; i < 3; ++i) {
      const double u = x + stream.uniform(-1.5, 1.5);
      const double v = y + stream.uniform(-1.0, 1.0);
      add_grass_tuft(scenery, stream, {u, v, height_on(ground, u, v)}, stream.uniform(0.1, 0.35), 5, "grass_dry");
    }
  }
}

/// Woods, a barn and fences around the orchard.
void add_surroundings(Outdoors& outdoors, const Terrain& ground, double half_length, double half_width,
                      std::uint64_t seed) {
  RandomStream stream(seed, "orchard/surroundings");
  const double x_edge = half_length + kHeadland_m + 3.0;
  const double y_edge = half_width + 6.0;
  const auto on_ground = [&](double x, double y) { return Vector3d(x, y, height_on(ground, x, y)); };
  for (int i = 0; i < 70; ++i) {
    const bool end = stream.uniform() < 0.5;
    const double sign = stream.uniform() < 0.5 ? -1.0 : 1.0;
    const double u = stream.uniform(-1.0, 1.0);
    const double out = stream.uniform(3.0, 26.0);
    const Vector3d foot =
        end ? on_ground(sign * (x_edge + out), u * y_edge) : on_ground(u * x_edge, sign * (y_edge + out));
    if (sign > 0.0 && !end && std::abs(foot.x()) < 16.0) continue;  // where the barn is
    add_tree(outdoors.scenery, stream, foot, draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), 0.8));
  }
  for (double x = -x_edge; x + 10.0 <= x_edge; x += 10.0) {
    add_fence(outdoors.scenery, stream, on_ground(x, -y_edge), on_ground(x + 10.0, -y_edge), Fence::kRails);
  }
  const Hall barn{.width_m = 16.0, .depth_m = 10.0, .eaves_m = 4.2, .wall = "barn_boards"};
  add_hall_building(outdoors.scenery, stream, upright_frame(on_ground(stream.uniform(-4.0, 4.0), y_edge + 6.0), 0.0),
                    barn);
  for (double x = -half_length; x <= half_length + 1.0; x += stream.uniform(18.0, 26.0)) {
    const double y = stream.uniform() < 0.5 ? -y_edge + 1.0 : y_edge - 1.0;
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, upright_frame(on_ground(x, y), 0.0), 6.0), 900.0, 30.0});
  }
}

/// Up one alley and down the next but one, as vehicles go: they could not turn into the next.
Route tour_of(const Terrain& ground, double half_length) {
  Route tour{.name = "tour", .points = {}, .closed = true};
  const auto add = [&](double x, double y) { tour.points.emplace_back(x, y, height_on(ground, x, y)); };
  const double end = half_length + 3.0;
  const int steps = static_cast<int>(std::ceil(2.0 * end / 1.25));
  const double turn = kRowSpacing_m;
  for (int i = 0; i < steps; ++i) add(-end + 2.0 * end * i / steps, -turn);
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi * i / 12.0;
    add(end + turn * std::sin(angle), -turn * std::cos(angle));
  }
  for (int i = 0; i < steps; ++i) add(end - 2.0 * end * i / steps, turn);
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi * i / 12.0;
    add(-end - turn * std::sin(angle), turn * std::cos(angle));
  }
  return tour;
}

SceneDescription build_orchard(const SceneValues& values, std::uint64_t world_seed) {
  const double half_length = 0.5 * values.at("row_length_m");
  const int rows = 2 * static_cast<int>(values.at("row_pairs"));
  const double half_width = 0.5 * rows * kRowSpacing_m;
  const Terrain ground = orchard_ground(half_length, half_width, derive_seed(world_seed, "orchard/land"));
  Outdoors outdoors;
  add_ground(outdoors.scenery, ground);
  for (int i = 0; i < rows; ++i) {
    const double y = (i - 0.5 * (rows - 1)) * kRowSpacing_m;
    add_row(outdoors.scenery, ground, half_length, y, values.at("leaf_density"), world_seed);
  }
  add_surroundings(outdoors, ground, half_length, half_width, world_seed);
  outdoors.routes.push_back(tour_of(ground, half_length));
  return finish_outdoors("orchard", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo orchard_scene() {
  return {.name = "orchard",
          .summary = "rows of fruit trees on grass",
          .parameters = {{"row_length_m", 50, 20, 200, "along x"},
                         {"row_pairs", 3, 2, 10, "half the number of rows", true},
                         {"leaf_density", 1, 0.2, 3, "sprays of leaves on every tree; 1: some 600"},
                         night_parameter()},
          .build = build_orchard,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
