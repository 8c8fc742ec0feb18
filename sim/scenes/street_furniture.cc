#include "sim/scenes/street_furniture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

/// x from one place to the other, level, and the rise between them.
struct Span {
  Pose frame;
  double length = 0.0;
  double rise = 0.0;
};

Span span_between(const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  return {upright_frame(from, std::atan2(along.y(), along.x())), along.head<2>().norm(), along.z()};
}

/// A board along a span, `low` to `high` above the ground.
void add_board(Scenery& scenery, const std::string& material, const Span& span, double from_x, double to_x, double low,
               double high, double y0, double y1) {
  const double slope = span.rise / span.length;
  scenery.prism(material,
                {{from_x, low + slope * from_x},
                 {to_x, low + slope * to_x},
                 {to_x, high + slope * to_x},
                 {from_x, high + slope * from_x}},
                y0, y1, span.frame);
}

void add_upright(Scenery& scenery, const std::string& material, const Pose& frame, const Vector3d& foot, double height,
                 double radius, int sides = 5) {
  scenery.rod(material, frame * foot, frame * (foot + Vector3d(0.0, 0.0, height)), radius, radius, sides);
}

void add_shelter(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double half = stream.uniform(1.4, 2.0);
  for (const double x : {-half, half}) {
    for (const double y : {0.0, 1.3}) add_upright(scenery, "steel", frame, {x, y, -0.2}, 2.55, 0.05);
  }
  scenery.box("roof_metal", {-half - 0.2, -0.3, 2.35}, {half + 0.2, 1.5, 2.45}, frame);
  scenery.sheet("glass", frame * Vector3d(-half, 1.3, 0.3), frame * Vector3d(half, 1.3, 0.3),
                frame * Vector3d(half, 1.3, 2.0), frame * Vector3d(-half, 1.3, 2.0));
  scenery.box(pick(stream, sign_materials()), {half - 0.04, 0.1, 0.3}, {half + 0.04, 1.25, 2.0}, frame);
  scenery.box("crate_wood", {-half + 0.2, 0.8, 0.42}, {half - 0.3, 1.2, 0.48}, frame);
}

void add_hoarding(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double half = stream.uniform(0.6, 1.4);
  add_upright(scenery, "steel", frame, {-0.7 * half, 0.0, -0.2}, 2.4, 0.05);
  add_upright(scenery, "steel", frame, {0.7 * half, 0.0, -0.2}, 2.4, 0.05);
  scenery.box(pick(stream, sign_materials()), {-half, -0.08, 0.7}, {half, 0.08, 2.4}, frame);
}

void add_planter(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double half = stream.uniform(0.4, 0.9);
  scenery.block("concrete_pale", {-half, -0.35, -0.2}, {half, 0.35, 0.5}, frame);
  for (int i = 0; i < 30; ++i) {
    const Vector3d foot(stream.uniform(-half, half), stream.uniform(-0.3, 0.3), 0.45);
    const Vector3d tip =
        foot + Vector3d(stream.uniform(-0.2, 0.2), stream.uniform(-0.2, 0.2), stream.uniform(0.2, 0.6));
    scenery.triangle("foliage_green", frame * foot, frame * Vector3d(foot + Vector3d(0.1, 0.1, 0.15)), frame * tip);
  }
}

}  // namespace

Vector3d add_street_lamp(Scenery& scenery, const Pose& frame, double height_m, double arm_m) {
  scenery.rod("steel", frame * Vector3d(0.0, 0.0, -0.3), frame * Vector3d(0.0, 0.0, height_m), 0.10, 0.06, 6);
  scenery.block("steel", {-0.13, -0.13, -0.2}, {0.13, 0.13, 0.9}, frame);
  scenery.rod("steel", frame * Vector3d(0.0, 0.0, height_m - 0.1), frame * Vector3d(0.0, -arm_m, height_m + 0.25), 0.05,
              0.04, 5);
  scenery.box("lamp_housing", {-0.16, -arm_m - 0.7, height_m + 0.18}, {0.16, -arm_m, height_m + 0.34}, frame);
  return frame * Vector3d(0.0, -arm_m - 0.35, height_m);
}

Vector3d add_path_lamp(Scenery& scenery, const Pose& frame, double height_m) {
  scenery.rod("steel", frame * Vector3d(0.0, 0.0, -0.3), frame * Vector3d(0.0, 0.0, height_m), 0.07, 0.05, 6);
  scenery.box("lamp_housing", {-0.22, -0.22, height_m}, {0.22, 0.22, height_m + 0.28}, frame);
  return frame * Vector3d(0.0, 0.0, height_m - 0.15);
}

void add_traffic_sign(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double height = stream.uniform(2.2, 2.7);
  add_upright(scenery, "pipe_galvanised", frame, {0.0, 0.0, -0.3}, height + 0.7, 0.035);
  const double size = stream.uniform(0.3, 0.45);
  const int sides = stream.uniform() < 0.4 ? 3 : (stream.uniform() < 0.5 ? 4 : 10);
  const std::string material = stream.uniform() < 0.5 ? "sign_red" : pick(stream, sign_materials());
  // The plate lies in the plane across the road: a prism along the road's axis.
  std::vector<Eigen::Vector2d> plate;
  const double turn = sides == 3 ? 0.5 * std::numbers::pi : std::numbers::pi / sides;
  for (int i = 0; i < sides; ++i) {
    const double angle = turn + 2.0 * std::numbers::pi * i / sides;
    plate.emplace_back(size * std::cos(angle), height - 0.1 + size * std::sin(angle));
  }
  const Pose across = frame * upright_frame(Vector3d::Zero(), -0.5 * std::numbers::pi);
  scenery.prism(material, plate, -0.06, -0.03, across);
  if (stream.uniform() < 0.4) {
    scenery.box("sign_white", {-0.06, -0.3, height - 0.85}, {-0.03, 0.3, height - 0.6}, frame);
  }
}

void add_pole(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double height = stream.uniform(7.5, 9.5);
  scenery.rod("bark", frame * Vector3d(0.0, 0.0, -0.4), frame * Vector3d(0.0, 0.0, height), 0.15, 0.10, 6);
  for (const double z : {height - 0.35, height - 1.1}) {
    scenery.box("crate_wood", {-0.06, -1.1, z}, {0.06, 1.1, z + 0.12}, frame);
    for (const double y : {-1.0, -0.4, 0.4, 1.0}) {
      scenery.block("lamp_housing", {-0.04, y - 0.04, z + 0.12}, {0.04, y + 0.04, z + 0.28}, frame);
    }
  }
  if (stream.uniform() < 0.3) scenery.box("panels_grey", {-0.3, 0.15, height - 2.6}, {0.3, 0.7, height - 1.5}, frame);
}

void add_bench(Scenery& scenery, const Pose& frame) {
  for (const double x : {-0.75, 0.7}) scenery.block("concrete_grey", {x, -0.2, -0.1}, {x + 0.08, 0.25, 0.42}, frame);
  scenery.box("crate_wood", {-0.95, -0.22, 0.42}, {0.95, 0.22, 0.48}, frame);
  scenery.box("crate_wood", {-0.95, 0.22, 0.52}, {0.95, 0.27, 0.92}, frame);
}

void add_pavement_thing(Scenery& scenery, RandomStream& stream, const Pose& frame) {
  const double kind = stream.uniform();
  if (kind < 0.22) {
    const double half = stream.uniform(0.25, 0.35);
    scenery.block("barrel_blue", {-half, -half, -0.1}, {half, half, stream.uniform(0.9, 1.15)}, frame);
  } else if (kind < 0.40) {
    const double half = stream.uniform(0.35, 0.8);
    scenery.block("panels_grey", {-half, -0.2, -0.1}, {half, 0.25, stream.uniform(1.0, 1.5)}, frame);
  } else if (kind < 0.55) {
    for (int i = 0; i < 4; ++i) add_upright(scenery, "sign_white", frame, {1.5 * i, 0.0, -0.2}, 1.15, 0.07, 6);
  } else if (kind < 0.68) {
    add_bench(scenery, frame);
  } else if (kind < 0.76) {
    add_shelter(scenery, stream, frame);
  } else if (kind < 0.88) {
    add_hoarding(scenery, stream, frame);
  } else {
    add_planter(scenery, stream, frame);
  }
}

void add_fence(Scenery& scenery, RandomStream& stream, const Vector3d& from, const Vector3d& to, Fence fence) {
  const Span span = span_between(from, to);
  const double length = span.length;
  if (fence == Fence::kWall) {
    const std::string material = stream.uniform() < 0.5 ? "stone_dark" : "brick_pale";
    const double height = stream.uniform(0.6, 1.3);
    add_board(scenery, material, span, 0.0, length, -0.6, height, -0.14, 0.14);
    add_board(scenery, "stone_pale", span, 0.0, length, height, height + 0.08, -0.19, 0.19);
    return;
  }
  const double height = fence == Fence::kMesh ? 1.8 : stream.uniform(0.9, 1.2);
  const int posts = std::max(1, static_cast<int>(std::round(length / 2.5)));
  for (int i = 0; i <= posts; ++i) {
    const double x = length * i / posts;
    const double z = span.rise * i / posts;
    scenery.block(fence == Fence::kMesh ? "steel" : "crate_wood", {x - 0.05, -0.05, z - 0.4},
                  {x + 0.05, 0.05, z + height + 0.1}, span.frame);
  }
  const double rails[] = {0.25, height - 0.2};
  for (const double z : rails) add_board(scenery, "crate_wood", span, 0.0, length, z, z + 0.1, 0.05, 0.09);
  if (fence == Fence::kRails) return;
  const double pitch = fence == Fence::kMesh ? 0.5 : 0.32;
  const double width = fence == Fence::kMesh ? 0.03 : 0.14;
  for (double x = 0.1; x + width < length; x += pitch) {
    const double top = height + (fence == Fence::kMesh ? 0.0 : stream.uniform(-0.04, 0.04));
    const double z = span.rise * x / length;
    const auto at = [&](double dx, double up) { return span.frame * Vector3d(x + dx, 0.10, z + up); };
    scenery.sheet(fence == Fence::kMesh ? "steel" : "crate_wood", at(0.0, 0.05), at(width, 0.05), at(width, top),
                  at(0.0, top));
  }
}

void add_guard_rail(Scenery& scenery, const Vector3d& from, const Vector3d& to) {
  const Span span = span_between(from, to);
  const int posts = std::max(1, static_cast<int>(std::round(span.length / 4.0)));
  for (int i = 0; i < posts; ++i) {
    const double x = span.length * i / posts;
    const double z = span.rise * i / posts;
    scenery.block("steel", {x - 0.06, -0.05, z - 0.5}, {x + 0.06, 0.05, z + 0.72}, span.frame);
  }
  add_board(scenery, "guard_rail", span, 0.0, span.length, 0.44, 0.75, -0.13, -0.05);
}

void add_concrete_barrier(Scenery& scenery, const Vector3d& from, const Vector3d& to) {
  const Span span = span_between(from, to);
  add_board(scenery, "concrete_pale", span, 0.0, span.length, -0.3, 0.22, -0.30, 0.30);
  add_board(scenery, "concrete_pale", span, 0.0, span.length, 0.22, 0.85, -0.12, 0.12);
}

void add_marker_post(Scenery& scenery, const Pose& frame) {
  scenery.block("sign_white", {-0.04, -0.06, -0.2}, {0.04, 0.06, 0.72}, frame);
  scenery.block("car_black", {-0.045, -0.065, 0.72}, {0.045, 0.065, 0.95}, frame);
  scenery.box("sign_yellow", {-0.055, -0.03, 0.76}, {0.055, 0.03, 0.90}, frame);
}

void add_sign_gantry(Scenery& scenery, RandomStream& stream, const Pose& frame, double span_m) {
  for (const double y : {0.0, -span_m}) scenery.block("steel", {-0.2, y - 0.2, -0.5}, {0.2, y + 0.2, 7.4}, frame);
  scenery.box("steel", {-0.15, -span_m, 6.9}, {0.15, 0.0, 7.3}, frame);
  scenery.box("steel", {-0.15, -span_m, 5.9}, {0.15, 0.0, 6.1}, frame);
  double y = -1.0;
  while (y > -span_m + 4.0) {
    const double width = stream.uniform(2.6, 4.2);
    scenery.box("sign_blue", {-0.32, y - width, 5.7}, {-0.16, y, stream.uniform(7.6, 8.6)}, frame);
    y -= width + stream.uniform(0.5, 3.0);
  }
}

void add_rock(Scenery& scenery, RandomStream& stream, const Vector3d& foot, double size_m) {
  // A tetrahedral spindle: a ring of five corners, a top and nothing below ground.
  constexpr int kSides = 6;
  std::vector<Vector3d> ring;
  std::vector<Vector3d> crown;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + stream.uniform(-0.2, 0.2)) / kSides;
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const double reach = size_m * stream.uniform(0.7, 1.1);
    ring.push_back(foot + reach * out - Vector3d(0.0, 0.0, 0.3 * size_m));
    crown.push_back(foot + stream.uniform(0.45, 0.8) * reach * out +
                    Vector3d(0.0, 0.0, size_m * stream.uniform(0.35, 0.7)));
  }
  const Vector3d top = foot + Vector3d(0.0, 0.0, size_m * stream.uniform(0.6, 0.9));
  for (int i = 0; i < kSides; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>((i + 1) % kSides);
    scenery.quad("rock", ring[a], ring[b], crown[b], crown[a]);
    scenery.triangle("rock", crown[a], crown[b], top);
  }
}

}  // namespace plumbline
