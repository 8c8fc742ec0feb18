#include "sim/scenes/street.h"

#include <algorithm>
#include <string>

#include "sim/scenes/cars.h"
#include "sim/scenes/outdoors.h"
#include "sim/scenes/street_parts.h"
#include "sim/scenes/street_plan.h"

namespace plumbline {
namespace {

constexpr double kRouteInset_m = 4.0;  // of routes from the street's ends

/// Cars in the left lane, all at one speed, so that none catches up.
void add_traffic(Outdoors& outdoors, const Route& lane, double length_m, double cars_per_km, std::uint64_t seed) {
  RandomStream stream(seed, "street/traffic");
  const double speed = stream.uniform(9.0, 13.0);
  const int cars = static_cast<int>(std::floor(cars_per_km * length_m / 1000.0 + 0.5));
  const double headway = length_m / std::max(cars, 1);
  for (int i = 0; i < cars; ++i) {
    const std::string body = "car" + std::to_string(i);
    add_moving_car(outdoors.geoms, stream, body);
    const double start = (i + stream.uniform(0.0, 0.6)) * headway;
    outdoors.movers.push_back({body, lane, speed, start});
  }
}

SceneDescription build_street(const SceneValues& values, std::uint64_t world_seed) {
  const double length = values.at("length_m");
  const StreetPlan plan(length, values.at("rural_share"), world_seed);
  const auto bridged = [&](double s) { return plan.valley_depth(s); };

  Outdoors outdoors;
  Scenery& scenery = outdoors.scenery;
  add_ribbon(
      scenery, plan.line(), [&](double s) { return plan.section(s); }, 0.0, length, StreetPlan::kRow_m);
  add_far_land(scenery, plan.line(), StreetPlan::kHalfWidth_m, world_seed, bridged);
  add_plots(scenery, plan, world_seed);
  add_parked_cars(scenery, plan, values.at("parked_cars"), world_seed);
  add_furniture(outdoors, plan, world_seed);
  add_greenery(scenery, plan, values.at("leaf_density"), world_seed);
  add_bridges(scenery, plan, world_seed);

  const auto level = [](double) { return 0.0; };
  const double lane = 0.5 * StreetPlan::kLane_m;
  outdoors.routes.push_back(route_beside(plan.line(), "tour", kRouteInset_m, length - kRouteInset_m, -lane, level));
  outdoors.routes.push_back(route_beside(plan.line(), "back", length - kRouteInset_m, kRouteInset_m, lane, level));
  add_traffic(outdoors, outdoors.routes.back(), length, values.at("moving_cars_per_km"), world_seed);
  return finish_outdoors("street", std::move(outdoors), values.at("night") > 0.5, world_seed);
}

}  // namespace

SceneInfo street_scene() {
  return {.name = "street",
          .summary = "winding street through town and country, over hills and bridges, with traffic",
          .parameters = {{"length_m", 9300, 100, 12000, "along its middle"},
                         {"rural_share", 0.4, 0, 1, "share of stretches through fields and woods"},
                         {"parked_cars", 0.6, 0, 1, "share of the places along kerbs that are taken"},
                         {"moving_cars_per_km", 5, 0, 20, "in the lane opposite to the tour"},
                         {"leaf_density", 1, 0.3, 4, "sprays of leaves on every tree; 1: some 450"},
                         night_parameter()},
          .build = build_street,
          .usual_lux = kStreetLampLux};
}

}  // namespace plumbline
