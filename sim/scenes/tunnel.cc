#include "sim/scenes/tunnel.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/scenes/palette.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kLiningM = 0.2;
constexpr double kMinRibSpacingM = 2.0;

struct Plan {
  double half_length = 0.0;
  double half_width = 0.0;
  double height = 0.0;
  bool round = false;
  double rib_spacing = 0.0;
  double rib_depth = 0.0;
  double lamp_spacing = 0.0;
  std::uint64_t seed = 0;
};

/// A flat strip of the lining, all along the tunnel: seen in the section, y to the left and z up.
struct Strip {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double tilt = 0.0;  ///< about x; at 0 the strip faces up
  double width = 0.0;
  double overlap = 0.0;   ///< beyond each of its edges, behind the neighbouring strips' faces
  double shortest = 4.0;  ///< stretches of one material
  double longest = 8.0;
  std::vector<std::string> materials;
  std::string name;  ///< of its random stream
};

// The strip's frame has its face at z = 0, looking up along z.
Pose frame_of(const Strip& strip) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(strip.tilt, Eigen::Vector3d::UnitX())),
          {0.0, strip.middle.x(), strip.middle.y()}};
}

void add_strip(MjcfWriter& writer, const Plan& plan, const Strip& strip) {
  RandomStream stream(plan.seed, "tunnel/" + strip.name);
  const double y = strip.width / 2.0 + strip.overlap;
  const std::vector<double> cuts =
      random_cuts(stream, -plan.half_length, plan.half_length, strip.shortest, strip.longest);
  std::string material;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    material = pick_other_than(material, stream, strip.materials);
    writer.box(material, {cuts[i - 1], -y, -kLiningM}, {cuts[i], y, 0.0}, frame_of(strip));
  }
}

// Sign boards are part of the wall: a wall's face stays one plane whatever is painted on it.
std::vector<std::string> painted_wall_materials() {
  std::vector<std::string> names = wall_materials();
  names.insert(names.end(), {"sign_yellow", "sign_white", "notice_board"});
  return names;
}

std::vector<Strip> road_strips(double half_width) {
  constexpr double kLineHalfM = 0.1;
  const double lane = half_width - kLineHalfM;
  const double middle = kLineHalfM + lane / 2.0;
  return {{.middle = {-middle, 0.0}, .width = lane, .materials = road_materials(), .name = "road/right"},
          {.width = 2.0 * kLineHalfM,
           .shortest = 2.0,
           .longest = 4.0,
           .materials = {"road_paint", "asphalt"},
           .name = "road/line"},
          {.middle = {middle, 0.0}, .width = lane, .materials = road_materials(), .name = "road/left"}};
}

// Walls in two bands and a ceiling.
std::vector<Strip> box_lining(const Plan& plan) {
  const double band = 1.3;
  const double upper = plan.height - band;
  std::vector<Strip> strips;
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0.0 ? "right" : "left";
    const double y = side * plan.half_width;
    const double tilt = side * M_PI / 2.0;  // looks inwards
    strips.push_back(
        {.middle = {y, band / 2.0}, .tilt = tilt, .width = band, .materials = wall_materials(), .name = name + "/low"});
    strips.push_back({.middle = {y, band + upper / 2.0},
                      .tilt = tilt,
                      .width = upper,
                      .materials = painted_wall_materials(),
                      .name = name + "/high"});
  }
  strips.push_back({.middle = {0.0, plan.height},
                    .tilt = M_PI,
                    .width = 2.0 * plan.half_width,
                    .overlap = kLiningM,
                    .materials = {"concrete_pale", "concrete_grey", "plaster"},
                    .name = "ceiling"});
  return strips;
}

// An ellipse that the road cuts off below its middle, as a polygon.
std::vector<Strip> round_lining(const Plan& plan) {
  constexpr int kSides = 24;
  const double centre = 0.35 * plan.height;
  const auto vertex = [&](int i) {
    const double angle = 2.0 * M_PI * i / kSides;
    return Eigen::Vector2d(plan.half_width * std::cos(angle), centre + (plan.height - centre) * std::sin(angle));
  };
  std::vector<Strip> strips;
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Vector2d from = vertex(i);
    const Eigen::Vector2d to = vertex(i + 1);
    if (from.y() <= 0.0 && to.y() <= 0.0) continue;  // below the road
    const Eigen::Vector2d inward(from.y() - to.y(), to.x() - from.x());
    strips.push_back({.middle = (from + to) / 2.0,
                      .tilt = std::atan2(-inward.x(), inward.y()),
                      .width = (to - from).norm(),
                      .overlap = 0.05,
                      .shortest = 7.0,
                      .longest = 14.0,
                      .materials = painted_wall_materials(),
                      .name = "round" + std::to_string(i)});
  }
  return strips;
}

void add_ribs(MjcfWriter& writer, const Plan& plan, const std::vector<Strip>& lining) {
  constexpr double kRibHalfM = 0.15;
  RandomStream stream(plan.seed, "tunnel/ribs");
  const int count = static_cast<int>(2.0 * plan.half_length / plan.rib_spacing);
  for (int i = 0; i < count; ++i) {  // no two gaps are the same
    const double x = (i + 0.5 - count / 2.0 + stream.uniform(-0.15, 0.15)) * plan.rib_spacing;
    for (const Strip& strip : lining) {
      const double y = strip.width / 2.0;
      writer.box("concrete_pale", {x - kRibHalfM, -y, 0.0}, {x + kRibHalfM, y, plan.rib_depth}, frame_of(strip));
    }
  }
}

// No housings: they would stick out of the ceiling.
void add_lamps(MjcfWriter& writer, const Plan& plan) {
  RandomStream stream(plan.seed, "tunnel/lamps");
  const int count = static_cast<int>(2.0 * plan.half_length / plan.lamp_spacing);
  for (int i = 0; i < count; ++i) {
    const double x = (i + 0.5 - count / 2.0) * plan.lamp_spacing + stream.uniform(-0.8, 0.8);
    const double y = stream.uniform(-0.5, 0.5);
    writer.lamp({{x, y, plan.height - 0.7}, stream.uniform(200.0, 320.0), 14.0});
  }
}

Plan make_plan(const SceneValues& values, std::uint64_t world_seed) {
  const Plan plan{.half_length = values.at("length_m") / 2.0,
                  .half_width = values.at("width_m") / 2.0,
                  .height = values.at("height_m"),
                  .round = values.at("round_section") > 0.5,
                  .rib_spacing = values.at("rib_spacing_m"),
                  .rib_depth = values.at("rib_depth_m"),
                  .lamp_spacing = values.at("lamp_spacing_m"),
                  .seed = world_seed};
  if (plan.rib_spacing > 0.0 && plan.rib_spacing < kMinRibSpacingM) {
    throw std::invalid_argument("scene tunnel: rib_spacing_m is " + std::to_string(plan.rib_spacing) +
                                "; allowed are 0 for no ribs, or 2 to 100");
  }
  return plan;
}

Route along_the_middle(const Plan& plan) {
  constexpr double kClearOfEndsM = 15.0;
  const double x = plan.half_length - kClearOfEndsM;
  return make_route("along_the_middle", {{-x, 0.0, 0.0}, {x, 0.0, 0.0}}, 0.0);
}

SceneDescription build_tunnel(const SceneValues& values, std::uint64_t world_seed) {
  const Plan plan = make_plan(values, world_seed);
  MjcfWriter writer;
  const std::vector<Strip> lining = plan.round ? round_lining(plan) : box_lining(plan);
  for (const Strip& strip : lining) add_strip(writer, plan, strip);
  for (const Strip& strip : road_strips(plan.half_width)) add_strip(writer, plan, strip);
  if (plan.rib_spacing > 0.0) add_ribs(writer, plan, lining);
  add_lamps(writer, plan);
  SceneDescription scene = writer.finish("tunnel", scene_palette(), 25.0, 0.0);
  scene.routes = {along_the_middle(plan)};
  return scene;
}

}  // namespace

SceneInfo tunnel_scene() {
  return {.name = "tunnel",
          .summary = "straight smooth tunnel, open at both ends: nothing tells a lidar how far along it is",
          .parameters = {{"length_m", 270, 40, 600, "along x, centred at the origin"},
                         {"width_m", 4.5, 3, 10, "at its widest"},
                         {"height_m", 4, 3, 8, "above the road"},
                         {"round_section", 0, 0, 1, "0: box, 1: round vault", true},
                         {"rib_spacing_m", 0, 0, 100, "between ribs; 0: none, otherwise at least 2"},
                         {"rib_depth_m", 0.15, 0.02, 0.4, "by which ribs stand out of the walls"},
                         {"lamp_spacing_m", 7, 3, 30, "between lamps, give or take 0.8"}},
          .build = build_tunnel};
}

}  // namespace plumbline
