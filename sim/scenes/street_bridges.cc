#include <cmath>
#include <numbers>

#include "sim/scenes/palette.h"
#include "sim/scenes/street_furniture.h"
#include "sim/scenes/street_parts.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kDeckHalf_m = 5.0;
constexpr double kParapet_m = 0.95;

/// The deck with its parapets, round the whole section: lanes level with the road's.
Section deck_section() {
  const double w = kDeckHalf_m;
  Section section;
  section.stations = {{-w, -1.1},       {-w, kParapet_m}, {-w + 0.3, kParapet_m},
                      {-w + 0.3, 0.15}, {-w + 1.2, 0.15}, {-w + 1.2, 0.0},
                      {-0.08, 0.0},     {0.08, 0.0},      {w - 1.2, 0.0},
                      {w - 1.2, 0.15},  {w - 0.3, 0.15},  {w - 0.3, kParapet_m},
                      {w, kParapet_m},  {w, -1.1},        {-w, -1.1}};
  section.materials = {"concrete_pale", "concrete_pale", "concrete_grey", "paving",       "kerb",
                       "asphalt",       "road_paint",    "asphalt",       "kerb",         "paving",
                       "concrete_grey", "concrete_pale", "concrete_pale", "concrete_dark"};
  return section;
}

void add_valley_bridge(Scenery& scenery, RandomStream& stream, const StreetPlan& plan, const Feature& bridge) {
  const RoadLine& line = plan.line();
  // The ground falls away from the row before the bridge on: there the deck begins.
  const double from = bridge.s - bridge.half_m - StreetPlan::kRow_m;
  const double to = std::min(line.length(), bridge.s + bridge.half_m + StreetPlan::kRow_m);
  if (to - from < 5.0) return;
  add_ribbon(
      scenery, line, [](double) { return deck_section(); }, from, to, 2.5);
  const double pitch = stream.uniform(14.0, 19.0);
  for (double s = from + pitch; s < to - 6.0; s += pitch) {
    const double depth = plan.valley_depth(s);
    for (const double n : {-3.0, 3.0}) {
      const Vector3d top = line.place(s, n, -1.1);
      scenery.rod("concrete_grey", top - Vector3d(0.0, 0.0, depth + 1.0), top, 0.75, 0.6, 10);
    }
    scenery.box("concrete_grey", {-0.8, -4.4, -1.9}, {0.8, 4.4, -1.1}, line.frame(s, 0.0));
  }
  for (double s = from + 2.0; s < to; s += stream.uniform(11.0, 19.0)) {  // posts on the parapets
    const double side = stream.uniform() < 0.5 ? -1.0 : 1.0;
    scenery.block("steel", {-0.06, -0.06, 0.0}, {0.06, 0.06, stream.uniform(0.6, 2.4)},
                  line.frame(s, side * (kDeckHalf_m - 0.15), kParapet_m));
  }
  // The river, a little above the valley's floor.
  const double level = line.at(bridge.s).z() - plan.valley_depth(bridge.s) + 0.7;
  const double half = 0.45 * bridge.half_m;
  const auto bank = [&](double s, double n) {
    Vector3d place = line.place(s, n);
    place.z() = level;
    return place;
  };
  const double reach = StreetPlan::kHalfWidth_m;
  if (bridge.s + half > line.length()) return;
  scenery.quad("water", bank(bridge.s - half, -reach), bank(bridge.s + half, -reach), bank(bridge.s + half, reach),
               bank(bridge.s - half, reach));
}

/// A road on walls and pillars across ours, 5.4 m above it.
void add_overpass(Scenery& scenery, RandomStream& stream, const StreetPlan& plan, const Feature& overpass) {
  constexpr double kClear_m = 5.4;
  const double angle = stream.uniform(-0.15, 0.15);
  // x across our road, to its left.
  const Pose frame = plan.line().frame(overpass.s, 0.0, 0.0, 0.5 * std::numbers::pi + angle);
  const double half = stream.uniform(4.0, 5.5);
  const double abutment = plan.road_half(overpass.s) + plan.pavement_width(overpass.s) + 0.8;
  const double reach = StreetPlan::kHalfWidth_m - 3.0;
  const double deck = kClear_m + 0.9;
  scenery.box("concrete_pale", {-abutment - 1.0, -half, kClear_m}, {abutment + 1.0, half, deck}, frame);
  for (const double y : {-half + 1.2, 0.0, half - 1.2}) {
    scenery.box("concrete_dark", {-abutment, y - 0.3, kClear_m - 0.5}, {abutment, y + 0.3, kClear_m}, frame);
  }
  scenery.box("sign_yellow", {-2.0, half, kClear_m + 0.1}, {2.0, half + 0.06, kClear_m + 0.8}, frame);
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * abutment;
    const double outer = side * (abutment + 1.2);
    scenery.block(stream.uniform() < 0.5 ? "stone_dark" : "concrete_grey", {std::min(inner, outer), -half, -3.0},
                  {std::max(inner, outer), half, deck}, frame);
    std::vector<Eigen::Vector2d> ramp = {
        {side * abutment, -3.0}, {side * reach, -3.0}, {side * reach, -0.3}, {side * (abutment + 1.0), deck - 0.02}};
    if (side < 0.0) std::reverse(ramp.begin(), ramp.end());
    scenery.prism(stream.uniform() < 0.5 ? "stone_dark" : "concrete_grey", ramp, -half, half, frame);
    const double slope = (deck + 0.3) / (reach - abutment - 1.0);
    for (const double y : {-half, half - 0.25}) {
      const double far = side * (abutment + 0.6 * (reach - abutment));
      std::vector<Eigen::Vector2d> wall = {{side * abutment, deck},
                                           {far, deck - slope * (std::abs(far) - abutment - 1.0)},
                                           {far, deck - slope * (std::abs(far) - abutment - 1.0) + 1.0},
                                           {side * abutment, deck + 1.0}};
      if (side < 0.0) std::reverse(wall.begin(), wall.end());
      scenery.prism("concrete_pale", wall, y, y + 0.25, frame);
    }
  }
  for (const double y : {-half, half - 0.12}) {
    for (double x = -abutment; x <= abutment; x += 1.9) {
      scenery.block("railing", {x, y, deck}, {x + 0.08, y + 0.12, deck + 1.0}, frame);
    }
    scenery.box("railing", {-abutment, y, deck + 1.0}, {abutment, y + 0.12, deck + 1.1}, frame);
  }
}

}  // namespace

void add_bridges(Scenery& scenery, const StreetPlan& plan, std::uint64_t seed) {
  RandomStream stream(seed, "street/bridges");
  for (const Feature& feature : plan.features()) {
    RandomStream own(stream.bits(), "bridge");
    if (feature.kind == Feature::Kind::kValleyBridge) add_valley_bridge(scenery, own, plan, feature);
    if (feature.kind == Feature::Kind::kOverpass) add_overpass(scenery, own, plan, feature);
  }
}

}  // namespace plumbline
