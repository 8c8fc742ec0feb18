#include "sim/scenes/tunnel.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/tunnel_lining.h"
#include "sim/scenes/tunnel_share.h"
#include "sim/scenes/tunnel_things.h"

namespace plumbline {
namespace {

constexpr double kMinRibSpacing_m = 2.0;
constexpr double kClearOfEnds_m = 15.0;

// No housings: they would stick out of the ceiling.
void add_lamps(MjcfWriter& writer, const TunnelPlan& plan) {
  RandomStream stream(plan.seed, "tunnel/lamps");
  const int count = static_cast<int>((plan.line.end() - plan.line.begin()) / plan.lamp_spacing);
  for (int i = 0; i < count; ++i) {
    const double s = (i + 0.5 - count / 2.0) * plan.lamp_spacing + stream.uniform(-0.8, 0.8);
    const double y = stream.uniform(-0.5, 0.5);
    const Eigen::Vector3d place = plan.line.frame(s) * Eigen::Vector3d(0.0, y, plan.height - 0.7);
    writer.lamp({place, stream.uniform(200.0, 320.0), 14.0});
  }
}

TunnelPlan make_plan(const SceneValues& values, std::uint64_t world_seed) {
  const TunnelPlan plan{.line = TunnelLine(values.at("length_m"), values.at("bend_deg") * std::numbers::pi / 180.0),
                        .half_width = values.at("width_m") / 2.0,
                        .height = values.at("height_m"),
                        .round = values.at("round_section") > 0.5,
                        .roughness = values.at("roughness_m"),
                        .rib_spacing = values.at("rib_spacing_m"),
                        .rib_depth = values.at("rib_depth_m"),
                        .lamp_spacing = values.at("lamp_spacing_m"),
                        .axis_facing = values.at("axis_facing_percent") / 100.0,
                        .seed = world_seed};
  if (plan.rib_spacing > 0.0 && plan.rib_spacing < kMinRibSpacing_m) {
    throw std::invalid_argument("scene tunnel: rib_spacing_m is " + std::to_string(plan.rib_spacing) +
                                "; allowed are 0 for no ribs, or 2 to 100");
  }
  if (plan.line.bends() && plan.line.bend_end() > plan.line.end() - kClearOfEnds_m) {
    throw std::invalid_argument("scene tunnel: bend_deg is " + std::to_string(values.at("bend_deg")) +
                                "; a tunnel of this length_m has no room for it");
  }
  return plan;
}

Route along_the_middle(const TunnelPlan& plan) {
  constexpr double kStep_m = 2.5;
  const double from = plan.line.begin() + kClearOfEnds_m;
  const double length = plan.line.end() - kClearOfEnds_m - from;
  const int steps = static_cast<int>(std::ceil(length / kStep_m));
  Route route{.name = "along_the_middle", .points = {}};
  for (int i = 0; i <= steps; ++i) route.points.push_back(plan.line.frame(from + length * i / steps).translation);
  return route;
}

SceneDescription build_tunnel(const SceneValues& values, std::uint64_t world_seed) {
  const TunnelPlan plan = make_plan(values, world_seed);
  const std::vector<TunnelStrip> lining = tunnel_lining(plan);
  const std::vector<StandOut> ribs = tunnel_ribs(plan, lining);
  MjcfWriter writer;
  add_lining(writer, plan, lining);
  add_road(writer, plan);
  add_stand_outs(writer, plan, lining, ribs);
  add_stand_outs(writer, plan, lining, things_for_share(plan, lining, ribs));
  add_lamps(writer, plan);
  SceneDescription scene = writer.finish("tunnel", scene_palette(), 25.0, 0.0);
  scene.routes = {along_the_middle(plan)};
  return scene;
}

}  // namespace

SceneInfo tunnel_scene() {
  return {.name = "tunnel",
          .summary = "smooth tunnel, open at both ends: nothing tells a lidar how far along it is, unless asked for",
          .parameters = {{"length_m", 270, 40, 1000, "along the middle, centred at the origin"},
                         {"width_m", 4.5, 3, 10, "at its widest"},
                         {"height_m", 4, 3, 8, "above the road"},
                         {"round_section", 0, 0, 1, "0: box, 1: round vault", true},
                         {"bend_deg", 0, 0, 90, "to the left at three quarters of the length, radius 40 m"},
                         {"roughness_m", 0, 0, 0.1, "rms relief of walls and ceiling"},
                         {"rib_spacing_m", 0, 0, 100, "between ribs; 0: none, otherwise at least 2"},
                         {"rib_depth_m", 0.15, 0.02, 0.4, "by which ribs stand out of the walls"},
                         {"lamp_spacing_m", 7, 3, 30, "between lamps, give or take 0.8"},
                         {"axis_facing_percent", 0, 0, 25,
                          "of a VLP-16's returns, from things on the walls that face along the axis"}},
          .build = build_tunnel};
}

}  // namespace plumbline
