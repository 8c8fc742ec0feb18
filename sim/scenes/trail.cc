#include "sim/scenes/trail.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/foliage.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kHalfWidth_m = 32.0;
constexpr double kTread_m = 0.5;
constexpr double kRiser_m = 0.15;
constexpr double kSlope = kRiser_m / kTread_m;

/// Stairs from a whole metre to another: up or down.
struct Flight {
  double from_s = 0.0;
  double to_s = 0.0;
  double sign = 1.0;
  bool has(double s) const { return s > from_s && s < to_s; }
};

std::vector<Flight> draw_flights(double length_m, std::uint64_t seed) {
  RandomStream stream(seed, "trail/flights");
  std::vector<Flight> flights;
  double s = std::round(stream.uniform(14.0, 24.0));
  double sign = 1.0;
  while (s + 14.0 < length_m) {
    const double to = s + stream.integer(4, 11);
    flights.push_back({s, to, sign});
    if (stream.uniform() < 0.6) sign = -sign;
    s = to + stream.integer(18, 55);
  }
  return flights;
}

struct Plan {
  RoadLine line;
  std::vector<Flight> flights;
  std::uint64_t seed;

  bool on_stairs(double s) const {
    return std::any_of(flights.begin(), flights.end(), [&](const Flight& flight) { return flight.has(s); });
  }

  Section section(double s) const {
    const double sunk = on_stairs(s) ? 0.35 : 0.0;  // under the steps
    Section section;
    const double stations[] = {-kHalfWidth_m, -18.0, -9.0, -4.0, -1.9, -1.1, -0.4,
                               0.4,           1.1,   1.9,  4.0,  9.0,  18.0, kHalfWidth_m};
    for (const double n : stations) {
      const Vector3d place = line.place(s, n);
      const double away = std::clamp((std::abs(n) - 1.2) / 14.0, 0.0, 1.0);
      // Half of the hillside's slope goes across the path.
      const double side =
          0.14 * std::copysign(std::max(0.0, std::abs(n) - 1.5), n) * smooth_noise(seed + 3, s / 80.0, 0.0);
      const double bumps = std::abs(n) < 1.5 ? -sunk : 0.06 * smooth_noise(seed + 1, place.x() / 1.9, place.y() / 1.9);
      section.stations.push_back(
          {n, away * (0.3 + 2.4 * smooth_noise(seed, place.x() / 15.0, place.y() / 15.0)) + side + bumps});
    }
    const auto cover = [&](double n) {
      const double noise = smooth_noise(seed + 2, s / 7.0, n);
      return noise > 0.35 ? "grass_dry" : (noise > -0.2 ? "field" : "grass");
    };
    const auto path = [&](double n) { return smooth_noise(seed + 4, s / 6.0, n) > 0.2 ? "field" : "gravel"; };
    section.materials = {cover(1.0), cover(2.0), cover(3.0), cover(4.0), "grass",    path(1.0), path(3.0),
                         path(5.0),  "grass",    cover(5.0), cover(6.0), cover(7.0), cover(8.0)};
    return section;
  }
  Vector3d ground(double s, double n) const { return line.place(s, n, section(s).up_at(n)); }
};

Plan make_plan(double length_m, double hilliness, std::uint64_t seed) {
  const Winding winding{.length_m = length_m,
                        .min_radius_m = 40.0,
                        .max_radius_m = 90.0,
                        .heading_limit = 1.0,
                        .shortest_straight_m = 8.0,
                        .longest_straight_m = 40.0,
                        .easing_m = 10.0};
  const std::vector<Flight> flights = draw_flights(length_m, seed);
  const std::uint64_t land = derive_seed(seed, "trail/land");
  double climbed = 0.0;
  double last = 0.0;
  const auto height = [&, hilliness](double s) {  // asked for at one metre after the other
    const auto stairs = std::find_if(flights.begin(), flights.end(), [&](const Flight& f) { return f.has(s - 0.5); });
    if (stairs != flights.end()) {
      climbed += stairs->sign * kSlope;
    } else if (s > 0.0) {
      climbed += hilliness * (0.16 * std::sin(s / 45.0) + 0.05 * smooth_noise(land, s / 14.0, 0.0));
    }
    last = climbed;
    return last;
  };
  return {winding_line(winding, RandomStream(seed, "trail/line"), height), flights, land};
}

void add_stairs(Scenery& scenery, const Plan& plan, std::uint64_t seed) {
  RandomStream stream(seed, "trail/stairs");
  for (const Flight& flight : plan.flights) {
    const bool timber = stream.uniform() < 0.5;
    const int steps = static_cast<int>(std::lround((flight.to_s - flight.from_s) / kTread_m));
    for (int i = 0; i < steps; ++i) {
      const double s = flight.from_s + (i + 0.5) * kTread_m;
      // The line passes through the middle of every tread; a little overlap closes the steps in bends.
      const double half = 0.5 * kTread_m + 0.01;
      scenery.block(timber ? "crate_wood" : "stone_pale", {-half, -1.25, -0.6}, {half, 1.25, 0.0},
                    plan.line.frame(s, 0.0));
    }
    if (stream.uniform() < 0.6) {  // a hand rail
      const double side = stream.uniform() < 0.5 ? -1.4 : 1.4;
      for (double s = flight.from_s; s < flight.to_s; s += 2.0) {
        const Vector3d foot = plan.line.place(s, side, 0.0);
        scenery.rod("steel", foot - Vector3d(0.0, 0.0, 0.4), foot + Vector3d(0.0, 0.0, 1.0), 0.03, 0.03, 5);
      }
      scenery.rod("steel", plan.line.place(flight.from_s, side, 1.0), plan.line.place(flight.to_s, side, 1.0), 0.03,
                  0.03, 5);
    }
  }
}

void add_woods(Scenery& scenery, const Plan& plan, double density, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) {
    RandomStream stream(seed, sign > 0.0 ? "trail/woods/left" : "trail/woods/right");
    for (double s = 0.0; s < plan.line.length(); s += stream.uniform(1.8, 5.0)) {
      Tree tree = draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), 0.8 * density);
      const double off = 2.4 + 27.0 * std::pow(stream.uniform(), 1.6);
      if (off - tree.crown_radius_m < 2.0) tree.bole_m = std::max(tree.bole_m, 3.0);
      tree.height_m = std::max(tree.height_m, tree.bole_m + 3.0);
      add_tree(scenery, stream, plan.ground(s, sign * off), tree);
    }
    for (double s = 0.0; s < plan.line.length(); s += stream.uniform(0.4, 1.4)) {
      const double off = stream.uniform(1.7, 8.0);
      const double kind = stream.uniform();
      const Vector3d foot = plan.ground(s, sign * off);
      if (kind < 0.05) {
        add_rock(scenery, stream, foot + Vector3d(0.0, 0.0, -0.1), std::min(off - 1.4, stream.uniform(0.25, 1.0)));
      } else if (kind < 0.12 && off > 3.0) {
        add_bush(scenery, stream, foot, stream.uniform(0.4, 1.0), stream.uniform(0.5, 1.6), 50);
      } else if (kind < 0.14 && off > 4.0) {  // a fallen trunk
        const Vector3d along(stream.uniform(-3.0, 3.0), stream.uniform(-1.0, 1.0), 0.0);
        scenery.rod("bark", foot + Vector3d(0.0, 0.0, 0.15), foot + along + Vector3d(0.0, 0.0, 0.4), 0.2, 0.12, 6);
      } else {
        add_grass_tuft(scenery, stream, foot, stream.uniform(0.15, 0.5), 5, kind < 0.5 ? "grass" : "grass_dry");
      }
    }
  }
}

SceneDescription build_trail(const SceneValues& values, std::uint64_t world_seed) {
  const Plan plan = make_plan(values.at("length_m"), values.at("hilliness"), world_seed);
  const double length = plan.line.length();
  Outdoors outdoors;
  add_ribbon(
      outdoors.scenery, plan.line, [&](double s) { return plan.section(s); }, 0.0, length, 1.0);
  add_far_land(outdoors.scenery, plan.line, kHalfWidth_m, world_seed, [](double) { return -1.0; });
  add_stairs(outdoors.scenery, plan, world_seed);
  add_woods(outdoors.scenery, plan, values.at("leaf_density"), world_seed);
  RandomStream lamps(world_seed, "trail/lamps");
  for (double s = lamps.uniform(4.0, 12.0); s < length; s += lamps.uniform(15.0, 25.0)) {
    const double n = lamps.uniform() < 0.5 ? -1.75 : 1.75;
    Pose foot = plan.line.frame(s, n);
    foot.translation = plan.ground(s, n);
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot, lamps.uniform(2.8, 3.6)), 250.0, 18.0});
  }
  // A quarter of a metre past whole metres: there the line meets the middles of treads.
  const double begin = 2.0 + 0.5 * kTread_m;
  const double end = begin + std::floor(length - 4.0);
  outdoors.routes.push_back(route_beside(
      plan.line, "tour", begin, end, 0.0,
      [&](double s) { return plan.on_stairs(s) ? 0.0 : plan.section(s).up_at(0.0); }, 1.0));
  return finish_outdoors("trail", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo trail_scene() {
  return {.name = "trail",
          .summary = "foot path through hilly woods, with flights of stairs",
          .parameters = {{"length_m", 540, 60, 1500, "along its middle"},
                         {"hilliness", 1, 0, 2, "of the path between stairs; 1: gradients to 20 %"},
                         {"leaf_density", 1, 0.3, 3, "sprays of leaves on every tree; 1: some 350"},
                         night_parameter()},
          .build = build_trail,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
