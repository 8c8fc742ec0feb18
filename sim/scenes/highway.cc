#include "sim/scenes/highway.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/scenes/cars.h"
#include "sim/scenes/foliage.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kMedian_m = 1.6;  // half of it
constexpr double kInnerEdge_m = 2.1;
constexpr double kLane_m = 3.6;
constexpr double kOuterEdge_m = kInnerEdge_m + 2.0 * kLane_m;
constexpr double kPaved_m = kOuterEdge_m + 2.6;
constexpr double kHalfWidth_m = 60.0;
constexpr double kSlow_m = kInnerEdge_m + 1.5 * kLane_m;
constexpr double kFast_m = kInnerEdge_m + 0.5 * kLane_m;

struct HighwayPlan {
  RoadLine line;
  std::uint64_t seed;

  double relief(double s, double n) const {
    const double away = std::clamp((std::abs(n) - 14.0) / 30.0, 0.0, 1.0);
    const Vector3d place = line.place(s, n);
    return away * 3.5 * smooth_noise(seed, place.x() / 70.0, place.y() / 70.0);
  }

  Section section(double s) const {
    Section section;
    const auto add = [&](double n, double up) { section.stations.push_back({n, up}); };
    const double land[] = {kHalfWidth_m, 40.0, 25.0, 16.0};
    for (const double n : land) add(-n, relief(s, -n) - 0.5);
    for (const double n :
         {-kPaved_m - 1.0, -kPaved_m, -kOuterEdge_m - 0.2, -kOuterEdge_m, -kInnerEdge_m - kLane_m - 0.08,
          -kInnerEdge_m - kLane_m + 0.08, -kInnerEdge_m, -kInnerEdge_m + 0.15, -kMedian_m, 0.0}) {
      add(n, n < -kPaved_m ? -0.1 : 0.0);
    }
    for (std::size_t i = section.stations.size() - 1; i-- > 0;) {
      const double n = -section.stations[i].n;
      const bool on_land = n > kPaved_m + 2.0;
      add(n, on_land ? relief(s, n) - 0.5 : section.stations[i].up);
    }
    // Dashes of 6 m every 18 m, a little irregular.
    const bool dash = std::fmod(s + 1.5 * smooth_noise(seed + 3, s / 40.0, 0.0) + 18.0, 18.0) < 6.0;
    const auto worn = [&](double n) { return smooth_noise(seed + 1, s / 55.0, n) > 0.2 ? "asphalt_worn" : "asphalt"; };
    const auto cover = [&](double n) {
      const double noise = smooth_noise(seed + 2, s / 90.0, n);
      return noise > 0.3 ? "field" : (noise > -0.1 ? "grass" : "grass_dry");
    };
    std::vector<std::string> right = {cover(-50.0), cover(-30.0), "grass",
                                      "grass",      "gravel",     worn(-11.0),
                                      "road_paint", worn(-7.0),   dash ? "road_paint" : worn(-7.0),
                                      worn(-3.0),   "road_paint", worn(-2.0),
                                      "grass_dry"};
    std::vector<std::string> left = {cover(50.0),  cover(30.0),  "grass",
                                     "grass",      "gravel",     worn(11.0),
                                     "road_paint", worn(7.0),    dash ? "road_paint" : worn(7.0),
                                     worn(3.0),    "road_paint", worn(2.0),
                                     "grass_dry"};
    section.materials = right;
    section.materials.insert(section.materials.end(), left.rbegin(), left.rend());
    return section;
  }

  Vector3d ground(double s, double n) const { return line.place(s, n, section(s).up_at(n)); }
  Pose stand(double s, double n, double yaw) const {
    Pose frame = line.frame(s, n, 0.0, yaw);
    frame.translation = ground(s, n);
    return frame;
  }
};

HighwayPlan make_plan(double length_m, std::uint64_t seed) {
  const Winding winding{.length_m = length_m,
                        .min_radius_m = 450.0,
                        .max_radius_m = 1500.0,
                        .heading_limit = 0.5,
                        .shortest_straight_m = 150.0,
                        .longest_straight_m = 900.0,
                        .easing_m = 60.0};
  RandomStream hills(seed, "highway/hills");
  const double phase = hills.uniform(0.0, 6.0);
  return {winding_line(winding, RandomStream(seed, "highway/line"),
                       [&](double s) { return 12.0 * (std::sin(s / 310.0 + phase) - std::sin(phase)); }),
          derive_seed(seed, "highway/land")};
}

void add_barriers(Scenery& scenery, const HighwayPlan& plan, std::uint64_t seed) {
  constexpr double kPiece_m = 12.0;
  RandomStream stream(seed, "highway/barriers");
  bool outer[2] = {false, true};
  for (double s = 0.0; s + kPiece_m <= plan.line.length(); s += kPiece_m) {
    for (const double n : {-0.5, 0.5}) {  // the rails look at their own carriageway
      const Vector3d a = plan.ground(s, n);
      const Vector3d b = plan.ground(s + kPiece_m, n);
      if (n < 0.0) {
        add_guard_rail(scenery, a, b);
      } else {
        add_guard_rail(scenery, b, a);
      }
    }
    for (const int side : {0, 1}) {
      if (stream.uniform() < 0.06) outer[side] = !outer[side];
      if (!outer[side]) continue;
      const double n = (side == 0 ? -1.0 : 1.0) * (kPaved_m + 0.4);
      const Vector3d a = plan.ground(s, n);
      const Vector3d b = plan.ground(s + kPiece_m, n);
      if (side == 1) {
        add_guard_rail(scenery, a, b);
      } else {
        add_guard_rail(scenery, b, a);
      }
    }
  }
}

void add_things(Outdoors& outdoors, const HighwayPlan& plan, double trees_per_km, std::uint64_t seed) {
  Scenery& scenery = outdoors.scenery;
  const double length = plan.line.length();
  RandomStream posts(seed, "highway/posts");
  for (double s = posts.uniform(5.0, 30.0); s < length; s += posts.uniform(38.0, 56.0)) {
    for (const double sign : {-1.0, 1.0}) {
      add_marker_post(scenery, plan.stand(s + posts.uniform(-2.0, 2.0), sign * (kPaved_m + 0.9), 0.0));
    }
  }
  RandomStream lamps(seed, "highway/lamps");
  for (double s = lamps.uniform(10.0, 40.0); s < length; s += lamps.uniform(42.0, 66.0)) {
    const double sign = lamps.uniform() < 0.5 ? -1.0 : 1.0;
    const Pose foot = plan.stand(s, sign * (kPaved_m + 1.6), sign > 0.0 ? 0.0 : std::numbers::pi);
    outdoors.geoms.lamp({add_street_lamp(scenery, foot, lamps.uniform(9.0, 10.5), 2.2), 3000.0, 40.0});
  }
  RandomStream signs(seed, "highway/signs");
  for (double s = signs.uniform(40.0, 200.0); s < length - 10.0; s += signs.uniform(180.0, 520.0)) {
    if (signs.uniform() < 0.4) {
      add_sign_gantry(scenery, signs, plan.stand(s, -1.0, 0.0), kPaved_m + 0.6);
    } else {
      const Pose foot = plan.stand(s, -(kPaved_m + 1.8), 0.0);
      add_traffic_sign(scenery, signs, foot);
    }
  }
  RandomStream trees(seed, "highway/trees");
  const double spacing = 1000.0 / std::max(trees_per_km, 0.1);
  for (double s = trees.uniform(0.0, spacing); s < length; s += spacing * trees.uniform(0.3, 1.7)) {
    const double n = (trees.uniform() < 0.5 ? -1.0 : 1.0) * trees.uniform(20.0, 55.0);
    const Tree tree = draw_tree(trees, static_cast<Species>(trees.integer(0, 3)), 0.7);
    add_tree(scenery, trees, plan.ground(s, n), tree);
  }
}

void add_traffic(Outdoors& outdoors, const HighwayPlan& plan, double cars_per_km, std::uint64_t seed) {
  RandomStream stream(seed, "highway/traffic");
  const double length = plan.line.length();
  const auto level = [](double) { return 0.0; };
  const double offsets[] = {kSlow_m, kFast_m};
  const double speeds[] = {stream.uniform(22.0, 25.0), stream.uniform(30.0, 34.0)};
  const int cars = static_cast<int>(std::floor(0.5 * cars_per_km * length / 1000.0 + 0.5));
  for (int lane = 0; lane < 2; ++lane) {
    const Route path = route_beside(plan.line, "lane", length - 4.0, 4.0, offsets[lane], level);
    for (int i = 0; i < cars; ++i) {
      const std::string body = "car" + std::to_string(lane) + "_" + std::to_string(i);
      add_moving_car(outdoors.geoms, stream, body);
      outdoors.movers.push_back({body, path, speeds[lane], (i + stream.uniform(0.0, 0.6)) * length / cars});
    }
  }
}

SceneDescription build_highway(const SceneValues& values, std::uint64_t world_seed) {
  const double length = values.at("length_m");
  const HighwayPlan plan = make_plan(length, world_seed);
  Outdoors outdoors;
  add_ribbon(
      outdoors.scenery, plan.line, [&](double s) { return plan.section(s); }, 0.0, length, 3.0);
  add_far_land(outdoors.scenery, plan.line, kHalfWidth_m, world_seed, [](double) { return 0.0; });
  add_barriers(outdoors.scenery, plan, world_seed);
  add_things(outdoors, plan, values.at("trees_per_km"), world_seed);
  const auto level = [](double) { return 0.0; };
  outdoors.routes.push_back(route_beside(plan.line, "tour", 4.0, length - 4.0, -kSlow_m, level));
  outdoors.routes.push_back(route_beside(plan.line, "fast", 4.0, length - 4.0, -kFast_m, level));
  add_traffic(outdoors, plan, values.at("moving_cars_per_km"), world_seed);
  return finish_outdoors("highway", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo highway_scene() {
  return {.name = "highway",
          .summary = "motorway of two lanes each way: barriers, posts, signs and little else",
          .parameters = {{"length_m", 4300, 200, 8000, "along its middle"},
                         {"trees_per_km", 15, 0, 200, "scattered over the land beside it"},
                         {"moving_cars_per_km", 6, 0, 30, "on the other carriageway"},
                         night_parameter()},
          .build = build_highway,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
