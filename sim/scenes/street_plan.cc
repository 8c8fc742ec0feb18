#include "sim/scenes/street_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kKerb_m = 0.12;
constexpr double kBlend_m = 24.0;  // over which the section changes from district to district

/// Long waves of some 80 m from trough to crest, 3 km apart, with shorter ones on them: gradients stay below 12 %.
double line_height(std::uint64_t seed, double s) {
  RandomStream stream(seed, "street/hills");
  const double long_wave = stream.uniform(2800.0, 3300.0);
  const double short_wave = stream.uniform(430.0, 560.0);
  const double phase = stream.uniform(0.0, 2.0 * std::numbers::pi);
  const double turn = 2.0 * std::numbers::pi;
  return 40.0 * (1.0 - std::cos(turn * s / long_wave)) +
         2.2 * (std::sin(turn * s / short_wave + phase) - std::sin(phase));
}

RoadLine make_line(double length_m, std::uint64_t seed) {
  const Winding winding{.length_m = length_m,
                        .min_radius_m = 68.0,
                        .max_radius_m = 220.0,
                        .heading_limit = 1.15,
                        .shortest_straight_m = 40.0,
                        .longest_straight_m = 240.0,
                        .easing_m = 24.0};
  return winding_line(winding, RandomStream(seed, "street/line"), [&](double s) { return line_height(seed, s); });
}

std::vector<Stretch> draw_stretches(double length_m, double rural_share, std::uint64_t seed) {
  RandomStream stream(seed, "street/districts");
  std::vector<Stretch> stretches;
  while (stretches.empty() || stretches.back().to_s < length_m) {
    const double from = stretches.empty() ? 0.0 : stretches.back().to_s;
    const double to = from + stream.uniform(140.0, 420.0);
    const bool rural = stream.uniform() < rural_share;
    const double kind = stream.uniform();
    District district = District::kTown;
    if (rural) {
      district = kind < 0.6 ? District::kFields : District::kWood;
    } else if (kind > 0.5) {
      district = kind < 0.85 ? District::kSuburb : District::kWorks;
    }
    stretches.push_back({from, to, district});
  }
  return stretches;
}

double on_row(double s) { return std::round(s / StreetPlan::kRow_m) * StreetPlan::kRow_m; }

std::vector<Feature> draw_features(double length_m, std::uint64_t seed) {
  RandomStream stream(seed, "street/features");
  std::vector<Feature> features;
  double s = stream.uniform(60.0, 90.0);
  int bridges = 0;
  double next_bridge = stream.uniform(220.0, 400.0);
  while (s < length_m) {
    Feature feature;
    feature.s = s;
    if (s >= next_bridge) {
      const bool valley = bridges++ % 2 == 0;
      feature.kind = valley ? Feature::Kind::kValleyBridge : Feature::Kind::kOverpass;
      feature.half_m = valley ? stream.uniform(45.0, 70.0) : 14.0;
      feature.depth_m = valley ? stream.uniform(9.0, 14.0) : 0.0;
      if (valley) {  // a bridge begins and ends on a row of the ground
        feature.half_m = on_row(feature.half_m);
        feature.s = on_row(s + feature.half_m);
      }
      next_bridge = s + stream.uniform(450.0, 900.0);
    } else {
      feature.kind = Feature::Kind::kCrossing;
      feature.half_m = stream.uniform(3.4, 5.0);
    }
    features.push_back(feature);
    s = feature.s + feature.half_m + stream.uniform(55.0, 150.0);
  }
  return features;
}

double ease(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double road_half_of(District district) {
  switch (district) {
    case District::kTown:
      return StreetPlan::kLane_m + 2.2;  // a row of parked cars
    case District::kSuburb:
    case District::kWorks:
      return StreetPlan::kLane_m + 1.9;
    case District::kFields:
    case District::kWood:
      break;
  }
  return StreetPlan::kLane_m + 0.4;
}

double pavement_of(District district) { return is_rural(district) ? 1.6 : 2.6; }
double kerb_of(District district) { return is_rural(district) ? -0.03 : kKerb_m; }
double relief_of(District district) {
  if (district == District::kTown || district == District::kWorks) return 0.25;
  return district == District::kSuburb ? 0.7 : 2.6;
}
/// A ditch beside country roads.
double ditch_of(District district) { return is_rural(district) ? 0.35 : -0.02; }

std::string verge_material(District district, double noise) {
  switch (district) {
    case District::kTown:
      return noise > 0.55 ? "gravel" : "paving";
    case District::kWorks:
      return noise > 0.0 ? "asphalt_worn" : "gravel";
    case District::kSuburb:
      return "grass";
    case District::kFields:
    case District::kWood:
      break;
  }
  return noise > 0.4 ? "grass_dry" : "grass";
}

std::string land_material(District district, double noise) {
  if (district == District::kFields) return noise > 0.1 ? "field" : (noise > -0.3 ? "grass" : "grass_dry");
  if (district == District::kWood) return noise > 0.3 ? "field" : "grass";
  return noise > 0.5 ? "grass_dry" : "grass";
}

}  // namespace

bool is_rural(District district) { return district == District::kFields || district == District::kWood; }

StreetPlan::StreetPlan(double length_m, double rural_share, std::uint64_t seed)
    : seed_(derive_seed(seed, "street/plan")),
      line_(make_line(length_m, seed)),
      stretches_(draw_stretches(length_m, rural_share, seed)),
      features_(draw_features(length_m, seed)) {}

const Stretch& StreetPlan::stretch_at(double s) const {
  const auto after = std::partition_point(stretches_.begin(), stretches_.end(),
                                          [&](const Stretch& stretch) { return stretch.to_s <= s; });
  return after == stretches_.end() ? stretches_.back() : *after;
}

bool StreetPlan::is_kept_free(double from_s, double to_s, double margin_m) const {
  return std::any_of(features_.begin(), features_.end(), [&](const Feature& feature) {
    const double reach = feature.half_m + margin_m;
    return feature.s + reach > from_s && feature.s - reach < to_s;
  });
}

/// A district's value, or between two where one changes into the next.
double StreetPlan::blend(double s, double (*value)(District)) const {
  const Stretch& here = stretch_at(s);
  const Stretch& next = stretch_at(here.to_s + 0.5);
  const double own = value(here.district);
  if (&next == &here) return own;
  return own + ease((s - here.to_s + kBlend_m) / kBlend_m) * (value(next.district) - own);
}

double StreetPlan::road_half(double s) const { return blend(s, road_half_of); }
double StreetPlan::pavement_width(double s) const { return blend(s, pavement_of); }

const Feature* StreetPlan::bridge_at(double s) const {
  for (const Feature& feature : features_) {
    if (feature.kind == Feature::Kind::kValleyBridge && std::abs(s - feature.s) <= feature.half_m) return &feature;
  }
  return nullptr;
}

const Feature* StreetPlan::crossing_at(double s) const {
  for (const Feature& feature : features_) {
    if (feature.kind == Feature::Kind::kCrossing && std::abs(s - feature.s) <= feature.half_m) return &feature;
  }
  return nullptr;
}

double StreetPlan::valley_depth(double s) const {
  const Feature* bridge = bridge_at(s);
  if (!bridge) return 0.0;
  const double inside = bridge->half_m - std::abs(s - bridge->s);
  return 0.4 + bridge->depth_m * ease(inside / (0.55 * bridge->half_m));
}

/// The land's waves, growing away from the road.
double StreetPlan::relief(double s, double n) const {
  const double away = std::clamp((std::abs(n) - 9.0) / 40.0, 0.0, 1.0);
  const Eigen::Vector3d place = line_.place(s, n);
  const double waves = smooth_noise(seed_, place.x() / 31.0, place.y() / 31.0) +
                       0.4 * smooth_noise(seed_ + 1, place.x() / 11.0, place.y() / 11.0);
  return blend(s, relief_of) * away * (waves + 0.4);
}

Section StreetPlan::section(double s) const {
  const District district = stretch_at(s).district;
  const double half = road_half(s);
  const double pavement = half + pavement_width(s);
  const Feature* crossing = crossing_at(s);
  const double kerb = crossing ? 0.0 : blend(s, kerb_of);
  const double ditch = crossing ? 0.0 : blend(s, ditch_of);
  const double valley = valley_depth(s);
  const bool bridged = valley > 0.0;

  Section section;
  const auto add = [&](double n, double up) { section.stations.push_back({n, up - valley}); };
  const double land[] = {kHalfWidth_m, 40.0, 26.0, 15.0};
  for (const double n : land) add(-n, relief(s, -n) + kerb);
  add(-pavement - 1.2, kerb - ditch);
  add(-pavement, kerb);
  add(-half, kerb);
  add(-half, 0.0);
  add(-kLane_m + 0.02, 0.0);
  add(-kLane_m + 0.14, 0.0);
  add(-0.07, 0.0);
  add(0.07, 0.0);
  add(kLane_m - 0.14, 0.0);
  add(kLane_m - 0.02, 0.0);
  add(half, 0.0);
  add(half, kerb);
  add(pavement, kerb);
  add(pavement + 1.2, kerb - ditch);
  for (int i = 3; i >= 0; --i) add(land[i], relief(s, land[i]) + kerb);

  const auto noise = [&](double n) { return smooth_noise(seed_ + 2, s / 37.0, n / 23.0); };
  const auto side = [&](double sign) {
    std::vector<std::string> outwards;
    const bool side_street = crossing && !bridged;
    const std::string worn = noise(3.0 * sign) > 0.1 ? "asphalt_worn" : "asphalt";
    outwards.push_back(bridged ? "grass" : worn);                                // parking, shoulder
    outwards.push_back(bridged ? "grass" : (side_street ? "asphalt" : "kerb"));  // the kerb's face
    const std::string walk = is_rural(district) ? (noise(5.0 * sign) > 0.0 ? "gravel" : "grass_dry") : "paving";
    outwards.push_back(bridged ? "grass" : (side_street ? "asphalt" : walk));
    for (int i = 0; i < 2; ++i) {
      const std::string verge = verge_material(district, noise(9.0 * sign + i));
      outwards.push_back(bridged ? "grass" : (side_street ? "asphalt" : verge));
    }
    for (int i = 0; i < 3; ++i) {
      const std::string cover = land_material(district, noise(sign * (20.0 + 14.0 * i)));
      outwards.push_back(bridged ? (i == 1 ? "grass_dry" : "grass") : (side_street && i < 2 ? "asphalt" : cover));
    }
    return outwards;
  };
  const std::vector<std::string> right = side(-1.0);
  const std::vector<std::string> left = side(1.0);
  section.materials.assign(right.rbegin(), right.rend());
  const std::string lane_right = bridged ? "grass" : (noise(-1.7) > 0.25 ? "asphalt_worn" : "asphalt");
  const std::string lane_left = bridged ? "grass" : (noise(1.7) > 0.25 ? "asphalt_worn" : "asphalt");
  const bool dash = std::fmod(s + 6.0 * smooth_noise(seed_ + 3, s / 60.0, 0.0) + 10.0, 10.0) < 5.0;
  const bool marked = !bridged && !crossing;
  section.materials.push_back(marked ? "road_paint" : lane_right);
  section.materials.push_back(lane_right);
  section.materials.push_back(marked && dash ? "road_paint" : lane_right);
  section.materials.push_back(lane_left);
  section.materials.push_back(marked ? "road_paint" : lane_left);
  section.materials.insert(section.materials.end(), left.begin(), left.end());
  return section;
}

Pose StreetPlan::stand(double s, double n, double yaw) const {
  Pose frame = line_.frame(s, n, 0.0, yaw);
  frame.translation = ground(s, n);
  return frame;
}

}  // namespace plumbline
