#include "sim/scenes/vegetated_road.h"

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

using Eigen::Vector3d;

constexpr double kHalfWidth_m = 30.0;
constexpr double kRoadHalf_m = 1.9;

struct Plan {
  RoadLine line;
  std::uint64_t seed;

  Section section(double s) const {
    Section section;
    const double stations[] = {-kHalfWidth_m, -18.0, -9.0,        -4.0, -2.6, -kRoadHalf_m, -1.1, -0.5,
                               0.5,           1.1,   kRoadHalf_m, 2.6,  4.0,  9.0,          18.0, kHalfWidth_m};
    for (const double n : stations) {
      const Vector3d place = line.place(s, n);
      const double away = std::clamp((std::abs(n) - kRoadHalf_m) / 12.0, 0.0, 1.0);
      const double ruts = std::abs(n) < kRoadHalf_m ? 0.01 : 0.03;
      section.stations.push_back({n, away * (0.4 + 1.6 * smooth_noise(seed, place.x() / 17.0, place.y() / 17.0)) +
                                         ruts * smooth_noise(seed + 1, place.x() / 2.5, place.y() / 2.5)});
    }
    const auto cover = [&](double n) { return smooth_noise(seed + 2, s / 9.0, n) > 0.3 ? "grass_dry" : "grass"; };
    const auto track = [&](double n) { return smooth_noise(seed + 3, s / 13.0, n) > 0.1 ? "gravel" : "asphalt_worn"; };
    section.materials = {cover(1.0),  cover(2.0), cover(3.0), cover(4.0), "gravel",
                         "grass_dry", track(1.0), track(3.0), track(5.0), "grass_dry",
                         "gravel",    cover(5.0), cover(6.0), cover(7.0), cover(8.0)};
    return section;
  }
  Vector3d ground(double s, double n) const { return line.place(s, n, section(s).up_at(n)); }
};

void add_side(Scenery& scenery, const Plan& plan, double sign, double density, std::uint64_t seed) {
  const std::string name = sign > 0.0 ? "left" : "right";
  const double length = plan.line.length();
  RandomStream trees(seed, "vegetated road/trees/" + name);
  for (double s = trees.uniform(0.0, 4.0); s < length; s += trees.uniform(2.5, 6.5)) {
    Tree tree = draw_tree(trees, static_cast<Species>(trees.integer(0, 4)), 2.5 * density);
    const bool beside = trees.uniform() < 0.5;
    double off = trees.uniform(8.0, 24.0);
    if (beside) {
      tree.bole_m = std::max(tree.bole_m, 2.7);  // its crown may reach over the road
      tree.height_m = std::max(tree.height_m, tree.bole_m + 2.5);
      off = trees.uniform(2.9, 4.5);
    }
    add_tree(scenery, trees, plan.ground(s, sign * off), tree);
  }
  RandomStream bushes(seed, "vegetated road/bushes/" + name);
  for (double s = bushes.uniform(0.0, 4.0); s < length - 10.0; s += bushes.uniform(2.0, 7.0)) {
    const double kind = bushes.uniform();
    if (kind < 0.65) {
      const double radius = bushes.uniform(0.4, 1.1);
      add_bush(scenery, bushes, plan.ground(s, sign * (2.5 + radius + bushes.uniform(0.0, 3.0))), radius,
               bushes.uniform(0.6, 2.2), static_cast<int>(160 * radius * density));
    } else if (kind < 0.85) {
      const double off = sign * bushes.uniform(2.8, 3.4);
      const double run = bushes.uniform(4.0, 9.0);
      add_hedge(scenery, bushes, plan.ground(s, off), plan.ground(s + run, off), bushes.uniform(0.6, 1.0),
                bushes.uniform(0.9, 2.0), 45.0 * density);
      s += run;
    } else if (kind < 0.95) {
      add_fence(scenery, bushes, plan.ground(s, sign * 2.7), plan.ground(s + 8.0, sign * 2.7), Fence::kRails);
      s += 8.0;
    } else {
      add_rock(scenery, bushes, plan.ground(s, sign * 3.2), bushes.uniform(0.3, 0.7));
    }
  }
  RandomStream tufts(seed, "vegetated road/tufts/" + name);
  for (double s = 0.0; s < length; s += tufts.uniform(0.05, 0.25)) {
    const char* material = tufts.uniform() < 0.6 ? "grass" : "grass_dry";
    add_grass_tuft(scenery, tufts, plan.ground(s, sign * tufts.uniform(1.9, 7.0)), tufts.uniform(0.12, 0.6), 5,
                   material);
  }
}

SceneDescription build_vegetated_road(const SceneValues& values, std::uint64_t world_seed) {
  const Winding winding{.length_m = values.at("length_m"),
                        .min_radius_m = 40.0,
                        .max_radius_m = 120.0,
                        .heading_limit = 0.7,
                        .shortest_straight_m = 15.0,
                        .longest_straight_m = 60.0,
                        .easing_m = 14.0};
  const std::uint64_t land = derive_seed(world_seed, "vegetated road/land");
  const Plan plan{winding_line(winding, RandomStream(world_seed, "vegetated road/line"),
                               [land](double s) { return 2.5 * smooth_noise(land, s / 60.0, 0.5); }),
                  land};
  Outdoors outdoors;
  add_ribbon(
      outdoors.scenery, plan.line, [&](double s) { return plan.section(s); }, 0.0, plan.line.length(), 1.0);
  add_far_land(outdoors.scenery, plan.line, kHalfWidth_m, world_seed, [](double) { return -2.0; });
  for (const double sign : {-1.0, 1.0}) add_side(outdoors.scenery, plan, sign, values.at("leaf_density"), world_seed);
  RandomStream lamps(world_seed, "vegetated road/lamps");
  for (double s = lamps.uniform(4.0, 10.0); s < plan.line.length(); s += lamps.uniform(14.0, 22.0)) {
    const double sign = lamps.uniform() < 0.5 ? -1.0 : 1.0;
    Pose foot = plan.line.frame(s, sign * 2.45);
    foot.translation = plan.ground(s, sign * 2.45);
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot, lamps.uniform(3.2, 4.2)), 350.0, 18.0});
  }
  outdoors.routes.push_back(route_beside(
      plan.line, "tour", 3.0, plan.line.length() - 3.0, 0.0, [&](double s) { return plan.section(s).up_at(0.0); },
      2.0));
  return finish_outdoors("vegetated_road", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo vegetated_road_scene() {
  return {.name = "vegetated_road",
          .summary = "narrow lane between trees, hedges, bushes and high grass",
          .parameters = {{"length_m", 160, 60, 600, "along its middle"},
                         {"leaf_density", 1, 0.2, 2, "sprays of leaves on every plant; 1: some 1100 on a tree"},
                         night_parameter()},
          .build = build_vegetated_road,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
