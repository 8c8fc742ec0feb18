#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scenes/cars.h"
#include "sim/scenes/foliage.h"
#include "sim/scenes/street_furniture.h"
#include "sim/scenes/street_parts.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

// Furniture frames: x along the road, y away from it.
Pose stand_beside(const StreetPlan& plan, double s, double sign, double off) {
  return plan.stand(s, sign * off, sign > 0.0 ? 0.0 : std::numbers::pi);
}

const char* side_name(double sign) { return sign > 0.0 ? "left" : "right"; }

void add_lamps(Outdoors& outdoors, const StreetPlan& plan, std::uint64_t seed) {
  RandomStream stream(seed, "street/lamps");
  double sign = 1.0;
  for (double s = stream.uniform(6.0, 14.0); s < plan.line().length(); s += stream.uniform(24.0, 34.0)) {
    const bool rural = is_rural(plan.stretch_at(s).district);
    const double height = stream.uniform(6.0, 7.5);
    const double intensity = stream.uniform(900.0, 1800.0);
    sign = -sign;
    if ((rural && stream.uniform() < 0.6) || plan.is_kept_free(s, s, 1.0)) continue;
    const double off = plan.road_half(s) + 0.45;
    const Vector3d lamp =
        add_street_lamp(outdoors.scenery, stand_beside(plan, s, sign, off), height, rural ? 0.6 : 1.6);
    outdoors.geoms.lamp({lamp, intensity, 28.0});
  }
}

void add_signs_and_things(Scenery& scenery, const StreetPlan& plan, double sign, std::uint64_t seed) {
  RandomStream stream(seed, std::string("street/things/") + side_name(sign));
  for (double s = stream.uniform(3.0, 20.0); s < plan.line().length(); s += stream.uniform(7.0, 26.0)) {
    const bool rural = is_rural(plan.stretch_at(s).district);
    const double kind = stream.uniform();
    const std::uint64_t own = stream.bits();
    if (plan.is_kept_free(s, s, 2.5)) continue;
    RandomStream thing(own, "thing");
    const double off = plan.road_half(s) + 0.5;
    if (kind < 0.35) {
      // Signs face the traffic of their own side: on the left, that which comes the other way.
      add_traffic_sign(scenery, thing, plan.stand(s, sign * off, sign > 0.0 ? std::numbers::pi : 0.0));
    } else if (!rural) {
      add_pavement_thing(scenery, thing, stand_beside(plan, s, sign, plan.road_half(s) + 1.0));
    } else if (kind < 0.85) {
      add_marker_post(scenery, stand_beside(plan, s, sign, off));
    } else if (kind < 0.95) {
      add_rock(scenery, thing, plan.ground(s, sign * (off + 2.5)), thing.uniform(0.3, 0.8));
    }
  }
}

void add_poles(Scenery& scenery, const StreetPlan& plan, std::uint64_t seed) {
  RandomStream stream(seed, "street/poles");
  for (double s = stream.uniform(10.0, 30.0); s < plan.line().length(); s += stream.uniform(34.0, 52.0)) {
    const std::uint64_t own = stream.bits();
    if (plan.stretch_at(s).district == District::kTown || plan.is_kept_free(s, s, 4.0)) continue;
    RandomStream pole(own, "pole");
    add_pole(scenery, pole, stand_beside(plan, s, -1.0, plan.road_half(s) + 2.2));
  }
}

/// Rails for some 40 m at a time beside country roads, and before every bridge.
void add_rails(Scenery& scenery, const StreetPlan& plan, double sign, std::uint64_t seed) {
  constexpr double kPiece_m = 8.0;
  RandomStream stream(seed, std::string("street/rails/") + side_name(sign));
  for (double s = stream.uniform(0.0, 60.0); s < plan.line().length(); s += stream.uniform(60.0, 220.0)) {
    const double end = std::min(s + stream.uniform(24.0, 72.0), plan.line().length());
    for (; s + kPiece_m <= end; s += kPiece_m) {
      if (!is_rural(plan.stretch_at(s).district) || plan.is_kept_free(s, s + kPiece_m, 2.0)) continue;
      const Vector3d a = plan.ground(s, sign * (plan.road_half(s) + 0.35));
      const Vector3d b = plan.ground(s + kPiece_m, sign * (plan.road_half(s + kPiece_m) + 0.35));
      if (sign > 0.0) {
        add_guard_rail(scenery, a, b);
      } else {
        add_guard_rail(scenery, b, a);  // the rail is on the road's side of its posts
      }
    }
  }
}

void add_roadside_trees(Scenery& scenery, const StreetPlan& plan, double density, double sign, std::uint64_t seed) {
  RandomStream stream(seed, std::string("street/trees/") + side_name(sign));
  for (double s = stream.uniform(2.0, 12.0); s < plan.line().length();) {
    const District district = plan.stretch_at(s).district;
    const std::uint64_t own = stream.bits();
    const double step = is_rural(district) ? stream.uniform(9.0, 17.0) : stream.uniform(13.0, 24.0);
    const double here = s;
    s += step;
    if (district == District::kWorks || plan.is_kept_free(here, here, 6.0)) continue;
    RandomStream tree_stream(own, "tree");
    if (tree_stream.uniform() < 0.2) continue;
    const auto species = is_rural(district) ? static_cast<Species>(tree_stream.integer(0, 3))
                                            : static_cast<Species>(tree_stream.integer(0, 2));
    Tree tree = draw_tree(tree_stream, species, density);
    // Crowns end before the lanes and, in town, before the houses.
    const double room = is_rural(district) ? 4.0 : 1.9;
    tree.crown_radius_m = std::min(tree.crown_radius_m, room);
    const double off = plan.road_half(here) + (is_rural(district) ? tree.crown_radius_m + 0.8 : 0.75);
    if (!is_rural(district)) tree.bole_m = std::max(tree.bole_m, 3.0);
    add_tree(scenery, tree_stream, plan.ground(here, sign * off), tree);
  }
}

void add_wood(Scenery& scenery, const StreetPlan& plan, double density, double sign, std::uint64_t seed) {
  RandomStream stream(seed, std::string("street/wood/") + side_name(sign));
  for (double s = 0.0; s < plan.line().length(); s += stream.uniform(3.5, 7.5)) {
    const double off = stream.uniform(10.0, 34.0);
    const std::uint64_t own = stream.bits();
    const bool bridged = plan.is_kept_free(s, s, 3.0);
    if (plan.stretch_at(s).district != District::kWood || bridged) continue;
    RandomStream tree_stream(own, "tree");
    const auto species =
        tree_stream.uniform() < 0.45 ? Species::kSpruce : static_cast<Species>(tree_stream.integer(0, 2));
    add_tree(scenery, tree_stream, plan.ground(s, sign * off), draw_tree(tree_stream, species, 0.8 * density));
  }
}

/// Bushes, tufts and stones on the verges.
void add_undergrowth(Scenery& scenery, const StreetPlan& plan, double density, double sign, std::uint64_t seed) {
  RandomStream stream(seed, std::string("street/undergrowth/") + side_name(sign));
  for (double s = 0.0; s < plan.line().length(); s += stream.uniform(0.6, 2.2) / density) {
    const std::uint64_t own = stream.bits();
    if (!is_rural(plan.stretch_at(s).district) || plan.is_kept_free(s, s, 1.0)) continue;
    RandomStream plant(own, "plant");
    const double edge = plan.road_half(s) + plan.pavement_width(s);
    if (plant.uniform() < 0.06) {
      add_bush(scenery, plant, plan.ground(s, sign * (edge + plant.uniform(1.5, 5.0))), plant.uniform(0.5, 1.2),
               plant.uniform(0.6, 2.0), 40);
    } else {
      const char* material = plant.uniform() < 0.5 ? "grass" : "grass_dry";
      add_grass_tuft(scenery, plant, plan.ground(s, sign * (edge + plant.uniform(-0.9, 2.5))),
                     plant.uniform(0.15, 0.55), 5, material);
    }
  }
}

}  // namespace

void add_parked_cars(Scenery& scenery, const StreetPlan& plan, double parking_share, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) {
    RandomStream stream(seed, std::string("street/parked/") + side_name(sign));
    for (double s = stream.uniform(3.0, 8.0); s < plan.line().length() - 4.0; s += stream.uniform(5.6, 7.6)) {
      const bool taken = stream.uniform() < parking_share;
      const std::uint64_t own = stream.bits();
      const double room = plan.road_half(s) - StreetPlan::kLane_m;
      if (!taken || room < 1.85 || plan.is_kept_free(s, s, 5.0)) continue;
      RandomStream car(own, "car");
      const double across = StreetPlan::kLane_m + 0.5 * room + 0.12;
      const double yaw = (sign > 0.0 ? std::numbers::pi : 0.0) + car.uniform(-0.03, 0.03);
      Pose frame = plan.stand(s, sign * across, yaw);
      // Parked cars stand as steep as the road.
      const double grade = (plan.line().at(s + 1.0).z() - plan.line().at(s - 1.0).z()) / 2.0;
      frame.rotation =
          frame.rotation * Eigen::AngleAxisd((sign > 0.0 ? 1.0 : -1.0) * std::atan(grade), Vector3d::UnitY());
      add_parked_car(scenery, car, frame);
    }
  }
}

void add_furniture(Outdoors& outdoors, const StreetPlan& plan, std::uint64_t seed) {
  add_lamps(outdoors, plan, seed);
  add_poles(outdoors.scenery, plan, seed);
  for (const double sign : {-1.0, 1.0}) {
    add_signs_and_things(outdoors.scenery, plan, sign, seed);
    add_rails(outdoors.scenery, plan, sign, seed);
  }
}

void add_greenery(Scenery& scenery, const StreetPlan& plan, double leaf_density, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) {
    add_roadside_trees(scenery, plan, leaf_density, sign, seed);
    add_wood(scenery, plan, leaf_density, sign, seed);
    add_undergrowth(scenery, plan, std::min(1.0, leaf_density), sign, seed);
  }
}

}  // namespace plumbline
