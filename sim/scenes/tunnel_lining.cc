#include "sim/scenes/tunnel_lining.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "sim/scenes/mesh_builder.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/tunnel_relief.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kLining_m = 0.2;
constexpr double kRoughCell_m = 0.25;
constexpr double kBendCell_m = 1.0;    // 3 mm off the bend's arc
constexpr double kShortest_m = 0.001;  // of a stretch: the bend may begin anywhere

// Sign boards are part of the wall: a wall's face stays one plane whatever is painted on it.
std::vector<std::string> painted_wall_materials() {
  std::vector<std::string> names = wall_materials();
  names.insert(names.end(), {"sign_yellow", "sign_white", "notice_board"});
  return names;
}

// Walls in two bands and a ceiling.
std::vector<TunnelStrip> box_lining(const TunnelPlan& plan) {
  const double band = 1.3;
  const double upper = plan.height - band;
  std::vector<TunnelStrip> strips;
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
                    .overlap = kLining_m,
                    .materials = {"concrete_pale", "concrete_grey", "plaster"},
                    .name = "ceiling"});
  return strips;
}

// An ellipse that the road cuts off below its middle, as a polygon.
std::vector<TunnelStrip> round_lining(const TunnelPlan& plan) {
  constexpr int kSides = 24;
  const double centre = 0.35 * plan.height;
  const auto vertex = [&](int i) {
    const double angle = 2.0 * M_PI * i / kSides;
    return Eigen::Vector2d(plan.half_width * std::cos(angle), centre + (plan.height - centre) * std::sin(angle));
  };
  std::vector<TunnelStrip> strips;
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

struct Stretch {
  std::string material;
  double from = 0.0;
  double to = 0.0;
};

std::vector<Stretch> stretches_of(const TunnelPlan& plan, const TunnelStrip& strip) {
  RandomStream stream(plan.seed, "tunnel/" + strip.name);
  const std::vector<double> cuts =
      random_cuts(stream, plan.line.begin(), plan.line.end(), strip.shortest, strip.longest);
  std::vector<Stretch> stretches;
  std::string material;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    material = pick_other_than(material, stream, strip.materials);
    stretches.push_back({material, cuts[i - 1], cuts[i]});
  }
  return stretches;
}

// The stretches' parts within [from, to], which lies in one straight part of the tunnel.
void add_boxes(MjcfWriter& writer, const TunnelPlan& plan, const TunnelStrip& strip, double from, double to) {
  const double y = strip.width / 2.0 + strip.overlap;
  const Pose world_from_strip = plan.line.straight_frame((from + to) / 2.0) * frame_of(strip);
  for (const Stretch& stretch : stretches_of(plan, strip)) {
    const double begin = std::max(stretch.from, from);
    const double end = std::min(stretch.to, to);
    if (end - begin < kShortest_m) continue;
    writer.box(stretch.material, {begin, -y, -kLining_m}, {end, y, 0.0}, world_from_strip);
  }
}

/// Moves a point of the section at s.
using Displace = std::function<Eigen::Vector2d(double s, const Eigen::Vector2d& point)>;

// Rows along [from, to] and columns across, the same rows for every strip, so that neighbours share their edges.
void add_patch(MeshBuilder& mesh, const TunnelPlan& plan, const TunnelStrip& strip, double from, double to, double cell,
               const Displace& displace) {
  const int rows = std::max(1, static_cast<int>(std::ceil((to - from) / cell)));
  const int columns = std::max(1, static_cast<int>(std::ceil(strip.width / cell)));
  const auto points_at = [&](double s) {
    const Pose world_from_section = plan.line.frame(s);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= columns; ++i) {
      const double v = strip.width * (static_cast<double>(i) / columns - 0.5);
      const Eigen::Vector2d point = displace(s, strip.middle + v * strip.across());
      points.push_back(world_from_section * Eigen::Vector3d(0.0, point.x(), point.y()));
    }
    return points;
  };
  const std::vector<Stretch> stretches = stretches_of(plan, strip);
  std::size_t stretch = 0;
  std::vector<Eigen::Vector3d> near = points_at(from);
  for (int row = 0; row < rows; ++row) {
    const double middle = from + (to - from) * (row + 0.5) / rows;
    std::vector<Eigen::Vector3d> far = points_at(from + (to - from) * (row + 1.0) / rows);
    while (stretch + 1 < stretches.size() && stretches[stretch].to < middle) ++stretch;
    for (std::size_t i = 0; i + 1 < near.size(); ++i) {
      mesh.quad(stretches[stretch].material, near[i], far[i], far[i + 1], near[i + 1]);
    }
    near = std::move(far);
  }
}

void add_strips(MjcfWriter& writer, const TunnelPlan& plan, const std::vector<TunnelStrip>& strips, double roughness,
                const Displace& displace) {
  const TunnelLine& line = plan.line;
  MeshBuilder mesh;
  for (const TunnelStrip& strip : strips) {
    if (roughness > 0.0) {
      add_patch(mesh, plan, strip, line.begin(), line.end(), kRoughCell_m, displace);
    } else if (line.bends()) {
      add_boxes(writer, plan, strip, line.begin(), line.bend_begin());
      add_patch(mesh, plan, strip, line.bend_begin(), line.bend_end(), kBendCell_m, displace);
      add_boxes(writer, plan, strip, line.bend_end(), line.end());
    } else {
      add_boxes(writer, plan, strip, line.begin(), line.end());
    }
  }
  for (SceneMesh& part : mesh.take()) writer.mesh(std::move(part));
}

}  // namespace

Eigen::Vector2d TunnelStrip::across() const { return {std::cos(tilt), std::sin(tilt)}; }
Eigen::Vector2d TunnelStrip::normal() const { return {-std::sin(tilt), std::cos(tilt)}; }

Pose frame_of(const TunnelStrip& strip) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(strip.tilt, Eigen::Vector3d::UnitX())),
          {0.0, strip.middle.x(), strip.middle.y()}};
}

std::vector<TunnelStrip> tunnel_lining(const TunnelPlan& plan) {
  return plan.round ? round_lining(plan) : box_lining(plan);
}

std::vector<TunnelStrip> tunnel_road(const TunnelPlan& plan) {
  constexpr double kLineHalf_m = 0.1;
  const double under_rough_walls = 4.0 * plan.roughness;
  const double lane = plan.half_width + under_rough_walls - kLineHalf_m;
  const double middle = kLineHalf_m + lane / 2.0;
  return {{.middle = {-middle, 0.0}, .width = lane, .materials = road_materials(), .name = "road/right"},
          {.width = 2.0 * kLineHalf_m,
           .shortest = 2.0,
           .longest = 4.0,
           .materials = {"road_paint", "asphalt"},
           .name = "road/line"},
          {.middle = {middle, 0.0}, .width = lane, .materials = road_materials(), .name = "road/left"}};
}

void add_lining(MjcfWriter& writer, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining) {
  const TunnelRelief relief(plan, lining);
  add_strips(writer, plan, lining, plan.roughness,
             [&](double s, const Eigen::Vector2d& point) { return relief.displaced(s, point); });
}

void add_road(MjcfWriter& writer, const TunnelPlan& plan) {
  add_strips(writer, plan, tunnel_road(plan), 0.0, [](double, const Eigen::Vector2d& point) { return point; });
}

}  // namespace plumbline
