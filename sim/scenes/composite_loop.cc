#include "sim/scenes/composite_loop.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/corridor.h"
#include "sim/scenes/foliage.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The corridor lies along x from the origin, its floor at 0, in a building on level ground.
constexpr double kCorridor_m = 70.0;
constexpr double kGround_m = -2.4;
constexpr Unlit kDarkCorridor{22.0, 50.0};
constexpr double kLanding_m = 2.0;
constexpr double kTread_m = 0.3;
constexpr double kRiser_m = 0.15;
constexpr int kSteps = 16;  // the last one is the ground
constexpr double kStairs_m = kSteps * kTread_m;

// Where the loop leads after the stairs, in plan.
const std::vector<Vector2d> kTrail = {{86.0, 0.0}, {100.0, 9.0}, {117.0, 30.0}, {111.0, 58.0}, {119.0, 82.0}};
const std::vector<Vector2d> kAlongTheWall = {{116.0, 103.6}, {100.0, 118.0}, {2.0, 118.0}};
const std::vector<Vector2d> kDarkWoods = {{-32.0, 113.0}, {-54.0, 97.0}, {-62.0, 76.0}};
const std::vector<Vector2d> kOpen = {{-73.0, 42.0}, {-58.0, 8.0}, {-22.0, 0.0}};
constexpr double kWallY_m = 121.0;
constexpr double kWallHeight_m = 3.2;

/// Height of the walk over the ground's level: of the floor, or halfway up the steps.
double stair_profile(double x) {
  const double beyond = std::max(x - kCorridor_m, -x) - kLanding_m;  // of either landing
  return std::clamp(-beyond * kRiser_m / kTread_m, kGround_m, 0.0);
}

bool in_building(double x, double y) {
  const double end = kLanding_m + kStairs_m;
  return std::abs(y) < 2.0 && x > -end && x < kCorridor_m + end;
}

Terrain make_ground(std::uint64_t seed) {
  Terrain ground;
  ground.low = {-160.0, -80.0};
  ground.high = {200.0, 190.0};
  ground.cell_m = 2.5;
  ground.height = [seed](double x, double y) {
    // Hills along the trail alone: the stairs' foot, the wall and the open ground lie level.
    const double window = std::clamp((x - 86.0) / 14.0, 0.0, 1.0) * std::clamp((88.0 - y) / 12.0, 0.0, 1.0);
    return kGround_m + window * 2.2 * smooth_noise(seed, x / 24.0, y / 24.0);
  };
  ground.material = [seed](double x, double y) -> std::string {
    const double noise = smooth_noise(seed + 1, x / 9.0, y / 9.0);
    if (noise > 0.4) return "gravel";
    if (noise > 0.05) return "grass_dry";
    return noise > -0.35 ? "field" : "grass";
  };
  return ground;
}

/// The whole way in plan; where it climbs, corners stand at both ends of each stair.
std::vector<Vector2d> corners_of_loop() {
  std::vector<Vector2d> corners = {
      {0.5 * kDarkCorridor.from_m, 0.0}, {kCorridor_m + kLanding_m, 0.0}, {kCorridor_m + kLanding_m + kStairs_m, 0.0}};
  for (const auto* part : {&kTrail, &kAlongTheWall, &kDarkWoods, &kOpen}) {
    corners.insert(corners.end(), part->begin(), part->end());
  }
  corners.emplace_back(-kLanding_m - kStairs_m, 0.0);
  corners.emplace_back(-kLanding_m, 0.0);
  return corners;
}

Route make_loop(const Terrain& ground) {
  std::vector<Vector3d> corners;
  for (const Vector2d& corner : corners_of_loop()) corners.emplace_back(corner.x(), corner.y(), 0.0);
  Route loop = make_route("loop", corners, 8.0, true);
  for (Vector3d& p : loop.points) {
    p.z() = in_building(p.x(), p.y()) ? stair_profile(p.x()) : height_on(ground, p.x(), p.y());
  }
  return loop;
}

void add_building(Outdoors& outdoors, std::uint64_t seed) {
  Leg leg;
  leg.length = kCorridor_m;
  leg.half_width = 1.25;
  leg.height = 2.6;
  leg.name = "composite_loop/corridor";
  add_corridor_leg(outdoors.geoms, leg, 4.0, seed, kDarkCorridor);
  outdoors.geoms.box("concrete_grey", {-0.2, -1.45, kGround_m - 0.3}, {kCorridor_m + 0.2, 1.45, -0.2});
  for (const double sign : {-1.0, 1.0}) {
    const double edge = sign < 0.0 ? -0.2 : kCorridor_m + 0.2;
    const Pose outwards = upright_frame({edge, 0.0, 0.0}, sign < 0.0 ? M_PI : 0.0);
    Scenery& scenery = outdoors.scenery;
    scenery.block("concrete_grey", {0.0, -1.4, kGround_m - 0.3}, {kLanding_m - 0.2, 1.4, 0.0}, outwards);
    for (int i = 0; i + 1 < kSteps; ++i) {
      const double x = kLanding_m - 0.2 + i * kTread_m;
      scenery.block("stone_pale", {x, -1.4, kGround_m - 0.3}, {x + kTread_m, 1.4, -(i + 1) * kRiser_m}, outwards);
    }
  }
}

void add_smooth_wall(Outdoors& outdoors, std::uint64_t seed) {
  RandomStream stream(seed, "composite_loop/wall");
  std::string material;
  const std::vector<double> cuts = random_cuts(stream, -48.0, 150.0, 4.0, 9.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    material = pick_other_than(material, stream, wall_materials());
    outdoors.geoms.box(material, {cuts[i - 1], kWallY_m, kGround_m - 0.3},
                       {cuts[i], kWallY_m + 0.3, kGround_m + kWallHeight_m});
  }
}

/// Trees and undergrowth to both sides of a way, which stays clear.
void add_woods(Scenery& scenery, const Terrain& ground, const std::vector<Vector2d>& way, const std::string& name,
               double density, std::uint64_t seed) {
  RandomStream stream(seed, "composite_loop/" + name);
  for (std::size_t leg = 1; leg < way.size(); ++leg) {
    const Vector2d along = (way[leg] - way[leg - 1]).normalized();
    const Vector2d left(-along.y(), along.x());
    const double length = (way[leg] - way[leg - 1]).norm();
    const auto place = [&](double s, double n) {
      const Vector2d p = way[leg - 1] + s * along + n * left;
      return Vector3d(p.x(), p.y(), height_on(ground, p.x(), p.y()));
    };
    const auto off_the_way = [&](double least, double most) {
      return (stream.uniform() < 0.5 ? -1.0 : 1.0) * (least + (most - least) * std::pow(stream.uniform(), 1.4));
    };
    for (double s = stream.uniform(0.0, 3.0); s < length; s += stream.uniform(1.5, 4.0)) {
      Tree tree = draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), 0.8 * density);
      tree.bole_m = std::max(tree.bole_m, 3.0);
      tree.height_m = std::max(tree.height_m, tree.bole_m + 3.0);
      add_tree(scenery, stream, place(s, off_the_way(4.5, 15.0)), tree);
    }
    for (double s = stream.uniform(0.0, 1.0); s < length; s += stream.uniform(0.5, 1.5)) {
      const Vector3d foot = place(s, off_the_way(4.0, 10.0));
      if (stream.uniform() < 0.15) {
        add_rock(scenery, stream, foot + Vector3d(0.0, 0.0, -0.1), stream.uniform(0.25, 0.9));
      } else {
        add_grass_tuft(scenery, stream, foot, stream.uniform(0.15, 0.5), 5, stream.uniform() < 0.5 ? "grass" : "field");
      }
    }
  }
}

/// Lamps beside the trail, and floodlights on masts that no lidar of 30 m sees from the open stretches.
void add_lamps(Outdoors& outdoors, const Terrain& ground, std::uint64_t seed) {
  RandomStream stream(seed, "composite_loop/lamps");
  const auto foot_at = [&](const Vector2d& p) {
    return upright_frame({p.x(), p.y(), height_on(ground, p.x(), p.y())}, stream.uniform(0.0, 3.0));
  };
  for (std::size_t leg = 1; leg < kTrail.size(); ++leg) {
    const Vector2d along = (kTrail[leg] - kTrail[leg - 1]).normalized();
    for (double s = 3.0; s < (kTrail[leg] - kTrail[leg - 1]).norm(); s += stream.uniform(11.0, 16.0)) {
      const Vector2d beside = kTrail[leg - 1] + s * along + 2.6 * Vector2d(-along.y(), along.x());
      outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot_at(beside), stream.uniform(3.0, 3.6)), 600.0, 24.0});
    }
  }
  constexpr double kMast_m = 16.0;
  for (const Vector2d& mast :
       {Vector2d(76.0, 80.0), Vector2d(24.0, 80.0), Vector2d(-110.0, 10.0), Vector2d(-58.0, -42.0)}) {
    outdoors.geoms.lamp({add_path_lamp(outdoors.scenery, foot_at(mast), kMast_m), 150'000.0, 70.0});
  }
}

SceneDescription build_composite_loop(const SceneValues& values, std::uint64_t world_seed) {
  const Terrain ground = make_ground(derive_seed(world_seed, "composite_loop/land"));
  const double density = values.at("leaf_density");
  Outdoors outdoors;
  add_ground(outdoors.scenery, ground);
  add_building(outdoors, world_seed);
  add_smooth_wall(outdoors, world_seed);
  add_woods(outdoors.scenery, ground, kTrail, "trail", density, world_seed);
  add_woods(outdoors.scenery, ground, kDarkWoods, "dark_woods", density, world_seed);
  add_lamps(outdoors, ground, world_seed);
  outdoors.routes.push_back(make_loop(ground));
  return finish_outdoors("composite_loop", std::move(outdoors), true, world_seed);
}

}  // namespace

SceneInfo composite_loop_scene() {
  return {.name = "composite_loop",
          .summary = "a loop by night: corridor, stairs, trail, a wall, open ground; dark in two places",
          .parameters = {{"leaf_density", 1, 0.3, 3, "sprays of leaves on every tree; 1: some 350"}},
          .build = build_composite_loop,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
