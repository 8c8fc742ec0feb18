#include "sim/scenes/campus.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/scenes/cars.h"
#include "sim/scenes/foliage.h"
#include "sim/scenes/houses.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/ribbon.h"
#include "sim/scenes/street_furniture.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPathHalf_m = 2.4;
constexpr double kHalfWidth_m = 38.0;
constexpr double kCorner_m = 45.0;

struct CampusPlan {
  RoadLine line;
  std::uint64_t seed;

  Section section(double s) const {
    const Vector3d middle = line.at(s);
    const auto noise = [&](double n) { return smooth_noise(seed, middle.x() / 23.0, middle.y() / 23.0 + n); };
    const auto relief = [&](double n) {
      const Vector3d place = line.place(s, n);
      return 0.8 * std::clamp((std::abs(n) - 4.0) / 20.0, 0.0, 1.0) *
             smooth_noise(seed + 1, place.x() / 29.0, place.y() / 29.0);
    };
    Section section;
    const double stations[] = {-kHalfWidth_m,       -26.0,        -15.0, -7.0,        -kPathHalf_m - 0.15,
                               -kPathHalf_m - 0.15, -kPathHalf_m, 0.0,   kPathHalf_m, kPathHalf_m + 0.15,
                               kPathHalf_m + 0.15,  7.0,          15.0,  26.0,        kHalfWidth_m};
    for (std::size_t i = 0; i < std::size(stations); ++i) {
      const double n = stations[i];
      const bool edging = i == 5 || i == 9;
      section.stations.push_back({n, edging ? 0.06 : (std::abs(n) > kPathHalf_m ? relief(n) : 0.0)});
    }
    const auto lawn = [&](double n) { return noise(n) > 0.45 ? "grass_dry" : "grass"; };
    const auto path = [&](double n) {
      return noise(n) > 0.2 ? "paving" : (noise(n) > -0.35 ? "asphalt_worn" : "gravel");
    };
    section.materials = {lawn(1.0), lawn(2.0), lawn(3.0), "grass", "kerb",    "kerb",    path(0.5),
                         path(0.0), "kerb",    "kerb",    "grass", lawn(5.0), lawn(6.0), lawn(7.0)};
    return section;
  }
  Vector3d ground(double s, double n) const { return line.place(s, n, section(s).up_at(n)); }
  Pose stand(double s, double n, double yaw) const {
    Pose frame = line.frame(s, n, 0.0, yaw);
    frame.translation = ground(s, n);
    return frame;
  }
};

CampusPlan make_plan(double length_m, std::uint64_t seed) {
  RandomStream stream(seed, "campus/line");
  const int corners = length_m < 1000.0 ? 4 : 9;
  std::vector<Vector2d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + stream.uniform(-0.15, 0.15)) / corners;
    const double reach = corners == 4 ? 1.0 : stream.uniform(0.62, 1.0);
    polygon.emplace_back(1.35 * reach * std::cos(angle), reach * std::sin(angle));
  }
  const std::uint64_t land = derive_seed(seed, "campus/land");
  const auto height = [land](const Vector2d& p) {
    return 7.0 * smooth_noise(land, p.x() / 150.0, p.y() / 150.0) +
           1.0 * smooth_noise(land + 1, p.x() / 45.0, p.y() / 45.0);
  };
  // Corners that are scaled to the length first: their radius is in metres.
  double around = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) around += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  for (Vector2d& corner : polygon) corner *= length_m / around;
  return {closed_line(polygon, corners == 4 ? 40.0 : kCorner_m, length_m, height), derive_seed(seed, "campus/plan")};
}

House draw_institute(RandomStream& stream) {
  House house;
  house.width_m = stream.uniform(18.0, 38.0);
  house.depth_m = stream.uniform(11.0, 15.0);
  house.floors = stream.integer(2, 5);
  house.floor_m = stream.uniform(3.1, 3.8);
  house.roof = stream.uniform() < 0.75 ? Roof::kFlat : Roof::kGableAlong;
  house.wall = pick(stream, facade_materials());
  house.roofing = pick(stream, roof_materials());
  house.shop = stream.uniform() < 0.25;
  return house;
}

void add_buildings(Scenery& scenery, const CampusPlan& plan, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) {
    RandomStream stream(seed, sign > 0.0 ? "campus/left" : "campus/right");
    double s = stream.uniform(5.0, 15.0);
    while (s < plan.line.length() - 25.0) {
      const House house = draw_institute(stream);
      const double off = stream.uniform(5.0, 13.0);
      const double middle = s + 0.5 * house.width_m;
      s += house.width_m + stream.uniform(6.0, 38.0);
      // Inside a bend a long front would reach over the path.
      const double bend =
          std::abs(plan.line.heading(middle + 0.6 * house.width_m) - plan.line.heading(middle - 0.6 * house.width_m));
      if (bend > 0.25) continue;
      const double yaw = sign > 0.0 ? 0.0 : std::numbers::pi;
      add_house(scenery, stream, plan.stand(middle, sign * (kPathHalf_m + off), yaw), house);
    }
  }
}

/// Whether a place is on open ground: no wall within 2 m is known, so greenery keeps to where buildings never are.
void add_greenery(Scenery& scenery, const CampusPlan& plan, double density, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) {
    RandomStream stream(seed, sign > 0.0 ? "campus/green/left" : "campus/green/right");
    for (double s = stream.uniform(2.0, 10.0); s < plan.line.length(); s += stream.uniform(6.0, 17.0)) {
      const double kind = stream.uniform();
      if (kind < 0.6) {
        Tree tree = draw_tree(stream, static_cast<Species>(stream.integer(0, 3)), density);
        const bool behind = stream.uniform() < 0.35;
        if (!behind) {
          tree.crown_radius_m = std::min(tree.crown_radius_m, 2.2);
          tree.bole_m = std::max(tree.bole_m, 2.9);
        }
        add_tree(scenery, stream, plan.ground(s, sign * (behind ? 35.0 : kPathHalf_m + stream.uniform(2.3, 3.0))),
                 tree);
      } else if (kind < 0.8) {
        add_bush(scenery, stream, plan.ground(s, sign * (kPathHalf_m + stream.uniform(1.6, 3.2))),
                 stream.uniform(0.5, 1.0), stream.uniform(0.6, 1.6), 45);
      } else {
        const double off = sign * (kPathHalf_m + 1.0);
        const double length = stream.uniform(4.0, 9.0);
        add_hedge(scenery, stream, plan.ground(s, off), plan.ground(s + length, off), 0.8, stream.uniform(0.6, 1.1),
                  10.0);
      }
    }
    for (double s = 0.0; s < plan.line.length(); s += stream.uniform(1.0, 3.5)) {
      add_grass_tuft(scenery, stream, plan.ground(s, sign * (kPathHalf_m + stream.uniform(0.3, 4.0))),
                     stream.uniform(0.1, 0.3), 4, "grass");
    }
  }
}

void add_things(Outdoors& outdoors, const CampusPlan& plan, std::uint64_t seed) {
  RandomStream stream(seed, "campus/things");
  Scenery& scenery = outdoors.scenery;
  double sign = 1.0;
  for (double s = stream.uniform(4.0, 12.0); s < plan.line.length(); s += stream.uniform(18.0, 30.0)) {
    sign = -sign;
    const double yaw = sign > 0.0 ? 0.0 : std::numbers::pi;
    const Pose foot = plan.stand(s, sign * (kPathHalf_m + 0.5), yaw);
    outdoors.geoms.lamp({add_path_lamp(scenery, foot, stream.uniform(3.6, 4.4)), stream.uniform(250.0, 500.0), 20.0});
    const double beside = s + stream.uniform(4.0, 12.0);
    const Pose place = plan.stand(beside, -sign * (kPathHalf_m + 0.85), sign > 0.0 ? std::numbers::pi : 0.0);
    const double kind = stream.uniform();
    if (kind < 0.4) {
      add_bench(scenery, place);
    } else if (kind < 0.6) {
      add_traffic_sign(scenery, stream, place);
    } else if (kind < 0.72) {
      add_rock(scenery, stream, place.translation, 0.5);
    }
  }
}

SceneDescription build_campus(const SceneValues& values, std::uint64_t world_seed) {
  const CampusPlan plan = make_plan(values.at("length_m"), world_seed);
  Outdoors outdoors;
  const double length = plan.line.length();
  add_ribbon(
      outdoors.scenery, plan.line, [&](double s) { return plan.section(s); }, 0.0, length, 2.0);
  add_far_land(outdoors.scenery, plan.line, kHalfWidth_m, world_seed, [](double) { return -3.0; });
  add_buildings(outdoors.scenery, plan, world_seed);
  add_greenery(outdoors.scenery, plan, values.at("leaf_density"), world_seed);
  add_things(outdoors, plan, world_seed);
  Route tour = route_beside(
      plan.line, "tour", 0.0, length, 0.0, [](double) { return 0.0; }, 3.0);
  tour.points.pop_back();  // the first again
  tour.closed = true;
  outdoors.routes.push_back(std::move(tour));
  return finish_outdoors("campus", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo campus_scene() {
  return {.name = "campus",
          .summary = "closed path among the buildings, lawns and trees of a campus",
          .parameters = {{"length_m", 2700, 500, 4000, "of the path, once round"},
                         {"leaf_density", 1, 0.3, 4, "sprays of leaves on every tree; 1: some 450"},
                         night_parameter()},
          .build = build_campus,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
