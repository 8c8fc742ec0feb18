#include "sim/scenes/furniture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/scenes/palette.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

void add_legs(MjcfWriter& writer, const std::string& material, const Pose& frame, const Eigen::Vector2d& half,
              double height, double thickness) {
  for (const double x : {-half.x(), half.x() - thickness}) {
    for (const double y : {-half.y(), half.y() - thickness}) {
      writer.box(material, {x, y, 0.0}, {x + thickness, y + thickness, height}, frame);
    }
  }
}

// Boxes side by side on a board, each of its own height: books, files, jars.
void add_row(MjcfWriter& writer, RandomStream& stream, const Pose& frame, const Vector3d& from, double width,
             double depth, double tallest, const std::vector<std::string>& materials) {
  double x = 0.0;
  while (x < width - 0.15) {
    const double wide = std::min(stream.uniform(0.12, 0.45), width - x);
    const bool taken = stream.uniform() < 0.85;
    const Vector3d corner = from + Vector3d(x, 0.0, 0.0);
    const Vector3d size(wide - 0.01, depth * stream.uniform(0.6, 1.0), tallest * stream.uniform(0.55, 1.0));
    const std::string material = pick(stream, materials);
    if (taken) writer.box(material, corner, corner + size, frame);
    x += wide;
  }
}

}  // namespace

void add_table(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_table, const Eigen::Vector2d& size) {
  constexpr double kTopM = 0.74;
  const Eigen::Vector2d half = size / 2.0;
  const std::string wood = pick(stream, wood_materials());
  writer.box(wood, {-half.x(), -half.y(), kTopM - 0.04}, {half.x(), half.y(), kTopM}, world_from_table);
  add_legs(writer, wood, world_from_table, half - Eigen::Vector2d::Constant(0.08), kTopM - 0.04, 0.06);
}

void add_chair(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_chair) {
  const std::string seat = pick(stream, fabric_materials());
  writer.box(seat, {-0.22, -0.22, 0.42}, {0.24, 0.22, 0.48}, world_from_chair);
  writer.box(seat, {-0.26, -0.22, 0.55}, {-0.21, 0.22, 0.92}, world_from_chair);
  add_legs(writer, "steel", world_from_chair, {0.22, 0.21}, 0.42, 0.03);
  for (const double y : {-0.18, 0.15}) {
    writer.box("steel", {-0.24, y, 0.42}, {-0.21, y + 0.03, 0.60}, world_from_chair);
  }
}

void add_sofa(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m) {
  const std::string fabric = pick(stream, fabric_materials());
  const double x = width_m / 2.0;
  writer.box(fabric, {-x, 0.0, 0.08}, {x, 0.85, 0.42}, world_from_back);
  writer.box(fabric, {-x, 0.0, 0.42}, {x, 0.22, 0.85}, world_from_back);
  for (const double side : {-x, x - 0.18}) {
    writer.box(fabric, {side, 0.22, 0.42}, {side + 0.18, 0.85, 0.62}, world_from_back);
  }
  const double cushion = stream.uniform(-0.3, 0.3) * width_m;
  writer.box(pick_other_than(fabric, stream, fabric_materials()), {cushion - 0.2, 0.24, 0.42},
             {cushion + 0.2, 0.40, 0.75}, world_from_back);
}

void add_bookcase(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m,
                  double tall_m) {
  constexpr double kDepthM = 0.32;
  constexpr double kShelfM = 0.36;
  const std::string wood = pick(stream, wood_materials());
  const double x = width_m / 2.0;
  writer.box(wood, {-x, 0.0, 0.0}, {x, 0.03, tall_m}, world_from_back);
  for (const double side : {-x, x - 0.03}) {
    writer.box(wood, {side, 0.03, 0.0}, {side + 0.03, kDepthM, tall_m}, world_from_back);
  }
  for (double z = 0.08; z < tall_m - 0.05; z += kShelfM) {
    writer.box(wood, {-x + 0.03, 0.03, z}, {x - 0.03, kDepthM, z + 0.03}, world_from_back);
    if (z + kShelfM > tall_m) break;
    add_row(writer, stream, world_from_back, {-x + 0.04, 0.03, z + 0.03}, width_m - 0.08, 0.26, kShelfM - 0.06,
            {"book_spines", "notice_board", "carpet_red", "book_spines"});
  }
}

void add_cupboard(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back,
                  const Eigen::Vector3d& width_depth_height) {
  const double x = width_depth_height.x() / 2.0;
  const double depth = width_depth_height.y();
  const double tall = width_depth_height.z();
  const std::string wood = pick(stream, {"wood_pale", "wood_brown", "panels_white", "panels_grey"});
  writer.box(wood, {-x, 0.0, 0.0}, {x, depth - 0.02, tall}, world_from_back);
  for (const double side : {-1.0, 1.0}) {
    const double middle = side * x / 2.0;
    writer.box(wood, {middle - x / 2.0 + 0.015, depth - 0.02, 0.06}, {middle + x / 2.0 - 0.015, depth, tall - 0.03},
               world_from_back);
    writer.box("steel", {side * 0.08 - 0.01, depth, 0.48 * tall},
               {side * 0.08 + 0.01, depth + 0.03, 0.48 * tall + 0.15}, world_from_back);
  }
}

void add_desk(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, bool with_chair) {
  add_table(writer, stream, world_from_back * upright_frame({0.0, 0.36, 0.0}, 0.0), {1.4, 0.68});
  const double x = stream.uniform(-0.3, 0.3);
  writer.box("plastic_black", {x - 0.28, 0.15, 0.84}, {x + 0.28, 0.18, 1.18}, world_from_back);
  writer.box("plastic_black", {x - 0.08, 0.12, 0.74}, {x + 0.08, 0.22, 0.84}, world_from_back);
  const double papers = x + (x < 0.0 ? 0.45 : -0.45);
  writer.box("notice_board", {papers - 0.15, 0.25, 0.74}, {papers + 0.15, 0.55, 0.74 + stream.uniform(0.02, 0.1)},
             world_from_back);
  if (!with_chair) return;
  const Vector3d foot(stream.uniform(-0.2, 0.2), 0.85, 0.0);
  add_chair(writer, stream, world_from_back * upright_frame(foot, -M_PI / 2.0 + stream.uniform(-0.3, 0.3)));
}

void add_bed(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back) {
  writer.box(pick(stream, wood_materials()), {-1.0, 0.0, 0.0}, {1.0, 0.95, 0.3}, world_from_back);
  writer.box("fabric_white", {-0.98, 0.03, 0.3}, {0.98, 0.92, 0.48}, world_from_back);
  writer.box(pick(stream, fabric_materials()), {-0.98, 0.01, 0.4}, {0.45, 0.95, 0.54}, world_from_back);
  writer.box("fabric_white", {0.55, 0.15, 0.48}, {0.92, 0.8, 0.6}, world_from_back);
  writer.box(pick(stream, wood_materials()), {1.0, 0.0, 0.0}, {1.05, 0.95, 0.95}, world_from_back);
}

void add_kitchen(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m) {
  const double x = width_m / 2.0;
  const std::string front = pick(stream, {"wood_pale", "panels_white", "panels_green"});
  writer.box(front, {-x, 0.0, 0.08}, {x, 0.58, 0.86}, world_from_back);
  writer.box(pick(stream, wood_materials()), {-x, 0.0, 0.86}, {x, 0.62, 0.90}, world_from_back);
  writer.box(front, {-x, 0.0, 1.45}, {x - 0.7, 0.35, 2.1}, world_from_back);
  writer.box("steel", {x - 0.65, 0.05, 0.90}, {x - 0.1, 0.55, 0.92}, world_from_back);
  writer.box("steel", {x - 0.6, 0.0, 1.6}, {x - 0.1, 0.4, 1.75}, world_from_back);
  const int doors = static_cast<int>(width_m / 0.55);
  for (int i = 0; i < doors; ++i) {
    const double west = -x + width_m * i / doors;
    writer.box(front, {west + 0.015, 0.58, 0.12}, {west + width_m / doors - 0.015, 0.60, 0.82}, world_from_back);
  }
  add_row(writer, stream, world_from_back, {-x + 0.1, 0.08, 0.90}, width_m - 1.0, 0.25, 0.35,
          {"plastic_white", "barrel_orange", "steel", "plant_pot"});
}

void add_shelf(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m, double tall_m) {
  constexpr double kDepthM = 0.5;
  constexpr double kShelfM = 0.55;
  const double x = width_m / 2.0;
  for (const double side : {-x, x - 0.04}) {
    for (const double y : {0.0, kDepthM - 0.04}) {
      writer.box("steel", {side, y, 0.0}, {side + 0.04, y + 0.04, tall_m}, world_from_back);
    }
  }
  for (double z = 0.1; z < tall_m; z += kShelfM) {
    writer.box("steel", {-x, 0.0, z}, {x, kDepthM, z + 0.02}, world_from_back);
    add_row(writer, stream, world_from_back, {-x + 0.05, 0.02, z + 0.02}, width_m - 0.1, 0.45, kShelfM - 0.1,
            {"crate_wood", "crate_board", "barrel_orange", "barrel_blue", "plastic_white"});
  }
}

void add_plant(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_plant, double tall_m) {
  const double pot = 0.3 * tall_m;
  writer.cylinder("plant_pot", {0.0, 0.0, 0.0}, {0.0, 0.0, pot}, 0.14 * tall_m, world_from_plant);
  writer.cylinder("tree_bark", {0.0, 0.0, pot}, {0.0, 0.0, 0.7 * tall_m}, 0.02, world_from_plant);
  for (int i = 0; i < 6; ++i) {
    const double angle = stream.uniform(0.0, 2.0 * M_PI);
    const double out = stream.uniform(0.03, 0.10) * tall_m;
    const Vector3d centre(out * std::cos(angle), out * std::sin(angle), stream.uniform(0.5, 0.88) * tall_m);
    const Vector3d semi_axes =
        tall_m * Vector3d(stream.uniform(0.05, 0.1), stream.uniform(0.04, 0.08), stream.uniform(0.06, 0.12));
    writer.ellipsoid("plant_leaves", centre, semi_axes, world_from_plant);
  }
}

void add_picture(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_wall, double height_m) {
  const double wide = stream.uniform(0.4, 1.1);
  const double tall = stream.uniform(0.4, 0.8);
  add_fixture(writer, world_from_wall,
              {.material = "frame_paint", .height_m = height_m, .width_m = wide + 0.08, .tall_m = tall + 0.08});
  add_fixture(writer, world_from_wall,
              {.material = pick(stream, {"sign_blue", "notice_board", "carpet_red", "sign_yellow"}),
               .height_m = height_m,
               .width_m = wide,
               .tall_m = tall,
               .depth_m = 0.03});
}

}  // namespace plumbline
