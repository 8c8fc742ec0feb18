#include "sim/scenes/tunnel_things.h"

#include <algorithm>
#include <cmath>

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

// What stands on a wall, over a range of heights.
struct WallThing {
  double s = 0.0;
  double length = 0.0;
  double low_z = 0.0;
  double high_z = 0.0;
  double depth = 0.0;
  std::string material;
};

// Leaves the free way of the scene's description.
double deepest_on_wall(const TunnelPlan& plan) { return std::min(1.5, 0.44 * plan.half_width); }

// Leaves the lamps and a head's height.
double deepest_arch(const TunnelPlan& plan) { return std::min(deepest_on_wall(plan), 0.11 * plan.height); }

bool is_wall(const TunnelStrip& strip, double side) { return -side * strip.normal().x() > 0.5; }

// The part of each wall strip that lies between the two heights.
void append_on_wall(std::vector<StandOut>& stand_outs, const std::vector<TunnelStrip>& lining, double side,
                    const WallThing& thing) {
  constexpr double kLowest_m = 0.02;
  for (std::size_t i = 0; i < lining.size(); ++i) {
    const TunnelStrip& strip = lining[i];
    if (!is_wall(strip, side)) continue;
    const double rise = strip.across().y();
    const double a = (thing.low_z - strip.middle.y()) / rise;
    const double b = (thing.high_z - strip.middle.y()) / rise;
    const double low = std::max(std::min(a, b), -strip.width / 2.0);
    const double high = std::min(std::max(a, b), strip.width / 2.0);
    if (high - low < kLowest_m) continue;
    stand_outs.push_back(
        {i, thing.s - thing.length / 2.0, thing.s + thing.length / 2.0, low, high, thing.depth, thing.material});
  }
}

WallThing random_wall_thing(RandomStream& stream, const TunnelPlan& plan) {
  const double kind = stream.uniform();
  WallThing thing;
  if (kind < 0.5) {  // a pillar
    thing = {.length = stream.uniform(0.2, 0.5),
             .low_z = -1.0,
             .high_z = plan.height + 1.0,
             .depth = stream.uniform(0.5, 1.0),
             .material = pick(stream, {"concrete_pale", "concrete_dark", "brick_pale"})};
  } else if (kind < 0.8) {  // a cabinet
    const double low_z = stream.uniform(0.1, 0.7);
    thing = {.length = stream.uniform(0.5, 1.3),
             .low_z = low_z,
             .high_z = low_z + stream.uniform(0.9, 1.9),
             .depth = stream.uniform(0.4, 0.9),
             .material = pick(stream, {"panels_grey", "panels_green", "steel", "door_paint"})};
  } else {  // the flanges of a run of pipes
    const double low_z = stream.uniform(0.3, 1.9);
    thing = {.length = stream.uniform(0.06, 0.15),
             .low_z = low_z,
             .high_z = low_z + stream.uniform(0.3, 0.8),
             .depth = stream.uniform(0.3, 0.7),
             .material = pick(stream, {"pipe_red", "pipe_galvanised"})};
  }
  return thing;
}

void append_all_round(std::vector<StandOut>& stand_outs, const std::vector<TunnelStrip>& lining, double s,
                      double half_length, double depth) {
  for (std::size_t i = 0; i < lining.size(); ++i) {
    const double half = lining[i].width / 2.0;
    stand_outs.push_back({i, s - half_length, s + half_length, -half, half, depth, "concrete_pale"});
  }
}

void append_wall_things(std::vector<StandOut>& things, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining,
                        double side) {
  constexpr double kClosest_m = 1.0;
  constexpr double kFarthest_m = 2.8;
  constexpr double kClearOfEnds_m = 1.0;
  RandomStream stream(plan.seed, side < 0.0 ? "tunnel/things/right" : "tunnel/things/left");
  double s = plan.line.begin() + stream.uniform(kClosest_m, kFarthest_m);
  while (s < plan.line.end() - kClearOfEnds_m) {
    WallThing thing = random_wall_thing(stream, plan);
    thing.s = s;
    thing.depth *= deepest_on_wall(plan);
    append_on_wall(things, lining, side, thing);
    s += stream.uniform(kClosest_m, kFarthest_m);
  }
}

void append_arches(std::vector<StandOut>& things, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining) {
  constexpr double kClosest_m = 4.0;
  constexpr double kFarthest_m = 10.0;
  RandomStream stream(plan.seed, "tunnel/things/arches");
  double s = plan.line.begin() + stream.uniform(1.0, kFarthest_m);
  while (s < plan.line.end() - 1.0) {
    const double half_length = stream.uniform(0.1, 0.25);
    append_all_round(things, lining, s, half_length, stream.uniform(0.5, 1.0) * deepest_arch(plan));
    s += stream.uniform(kClosest_m, kFarthest_m);
  }
}

}  // namespace

std::vector<StandOut> tunnel_ribs(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining) {
  constexpr double kRibHalf_m = 0.15;
  if (plan.rib_spacing <= 0.0) return {};
  RandomStream stream(plan.seed, "tunnel/ribs");
  const int count = static_cast<int>((plan.line.end() - plan.line.begin()) / plan.rib_spacing);
  std::vector<StandOut> ribs;
  for (int i = 0; i < count; ++i) {
    const double s = (i + 0.5 - count / 2.0 + stream.uniform(-0.15, 0.15)) * plan.rib_spacing;
    append_all_round(ribs, lining, s, kRibHalf_m, plan.rib_depth);
  }
  return ribs;
}

std::vector<StandOut> tunnel_things(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining) {
  std::vector<StandOut> things;
  for (const double side : {-1.0, 1.0}) append_wall_things(things, plan, lining, side);
  append_arches(things, plan, lining);
  return things;
}

std::vector<StandOut> with_depths_scaled(const std::vector<StandOut>& things, double factor) {
  constexpr double kFlat_m = 0.002;
  std::vector<StandOut> scaled;
  for (StandOut thing : things) {
    thing.depth *= factor;
    if (thing.depth >= kFlat_m) scaled.push_back(std::move(thing));
  }
  return scaled;
}

void add_stand_outs(MjcfWriter& writer, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining,
                    const std::vector<StandOut>& stand_outs) {
  constexpr double kInTheWall_m = 0.15;  // beyond what a rough or bent wall leaves open
  for (const StandOut& thing : stand_outs) {
    const double half_length = (thing.to - thing.from) / 2.0;
    const Pose world_from_strip = plan.line.frame((thing.from + thing.to) / 2.0) * frame_of(lining[thing.strip]);
    writer.box(thing.material, {-half_length, thing.low, -kInTheWall_m}, {half_length, thing.high, thing.depth},
               world_from_strip);
  }
}

}  // namespace plumbline
