#include "sim/scenes/site_things.h"

#include <cmath>

#include "sim/scenes/palette.h"
#include "sim/scenes/walls.h"

namespace plumbline {

using Eigen::Vector3d;

void add_site_tree(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_tree, double tall_m) {
  const double fork = 0.4 * tall_m;
  writer.cylinder("tree_bark", {0.0, 0.0, 0.0}, {0.0, 0.0, fork}, 0.025 * tall_m, world_from_tree);
  for (int i = 0; i < 7; ++i) {
    const double angle = stream.uniform(0.0, 2.0 * M_PI);
    const double out = stream.uniform(0.02, 0.15) * tall_m;
    const Vector3d centre(out * std::cos(angle), out * std::sin(angle), stream.uniform(0.5, 0.85) * tall_m);
    if (i < 3) writer.capsule("tree_bark", {0.0, 0.0, fork}, centre, 0.012 * tall_m, world_from_tree);
    writer.ellipsoid(
        "plant_leaves", centre,
        tall_m * Vector3d(stream.uniform(0.09, 0.15), stream.uniform(0.09, 0.15), stream.uniform(0.07, 0.13)),
        world_from_tree);
  }
}

void add_lamp_post(MjcfWriter& writer, const Pose& world_from_post, double intensity_cd) {
  constexpr double kTallM = 4.5;
  writer.cylinder("steel", {0.0, 0.0, 0.0}, {0.0, 0.0, kTallM}, 0.06, world_from_post);
  writer.capsule("steel", {0.0, 0.0, kTallM}, {0.0, 0.8, kTallM + 0.15}, 0.04, world_from_post);
  writer.box("lamp_housing", {-0.1, 0.6, kTallM + 0.05}, {0.1, 1.1, kTallM + 0.15}, world_from_post);
  if (intensity_cd > 0.0) writer.lamp({world_from_post * Vector3d(0.0, 0.9, kTallM - 0.2), intensity_cd, 18.0});
}

void add_bench(MjcfWriter& writer, const Pose& world_from_bench) {
  writer.box("wood_brown", {-0.9, -0.2, 0.42}, {0.9, 0.25, 0.47}, world_from_bench);
  writer.box("wood_brown", {-0.9, -0.27, 0.55}, {0.9, -0.22, 0.85}, world_from_bench);
  for (const double x : {-0.7, 0.7}) {
    writer.box("concrete_grey", {x - 0.05, -0.25, 0.0}, {x + 0.05, 0.22, 0.42}, world_from_bench);
    writer.box("steel", {x - 0.03, -0.27, 0.4}, {x + 0.03, -0.2, 0.85}, world_from_bench);
  }
}

void add_hedge(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const Pose frame = upright_frame({from.x(), from.y(), 0.0}, std::atan2(along.y(), along.x()));
  const std::vector<double> cuts = random_cuts(stream, 0.0, along.norm(), 2.0, 5.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double half = stream.uniform(0.3, 0.45);
    writer.box("hedge", {cuts[i - 1], -half, 0.0}, {cuts[i], half, stream.uniform(1.2, 1.8)}, frame);
  }
}

void add_ridged_roof(MjcfWriter& writer, const Pose& world_from_roof, const Eigen::Vector2d& half_size, double rise_m) {
  constexpr double kEavesM = 0.5;
  constexpr double kThickM = 0.15;
  const double slope = std::atan2(rise_m, half_size.y());
  const double length = std::hypot(rise_m, half_size.y()) + kEavesM;
  for (const double side : {0.0, M_PI}) {
    // From the ridge down along +y.
    const Pose pane{
        Eigen::Quaterniond(Eigen::AngleAxisd(side, Vector3d::UnitZ()) * Eigen::AngleAxisd(-slope, Vector3d::UnitX())),
        {0.0, 0.0, rise_m}};
    writer.box("roof_tiles", {-half_size.x() - kEavesM, 0.0, 0.0}, {half_size.x() + kEavesM, length, kThickM},
               world_from_roof * pane);
  }
  constexpr int kSteps = 6;  // the gables, in steps that the roof hides
  for (int i = 0; i < kSteps; ++i) {
    const double y = half_size.y() * (1.0 - (i + 1.0) / kSteps);
    if (y <= 0.0) break;
    for (const double x : {-half_size.x(), half_size.x() - 0.2}) {
      writer.box("brick_pale", {x, -y, rise_m * i / kSteps}, {x + 0.2, y, rise_m * (i + 1.0) / kSteps},
                 world_from_roof);
    }
  }
}

void add_plain_house(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_house,
                     const Eigen::Vector3d& size) {
  const Vector3d half(size.x() / 2.0, size.y() / 2.0, 0.0);
  writer.box(pick(stream, {"brick_red", "brick_pale", "plaster", "concrete_pale"}), -half,
             half + Vector3d(0.0, 0.0, size.z()), world_from_house);
  for (double z = 1.0; z + 1.4 < size.z(); z += 2.8) {
    for (double x = -half.x() + 1.5; x < half.x() - 1.2; x += stream.uniform(2.2, 3.2)) {
      for (const double side : {-1.0, 1.0}) {
        const double y = side * (half.y() + 0.03);
        writer.box("frame_paint", {x - 0.7, y - 0.05, z - 0.1}, {x + 0.7, y + 0.05, z + 1.4}, world_from_house);
        writer.box("glass", {x - 0.6, y - 0.06, z}, {x + 0.6, y + 0.06, z + 1.3}, world_from_house);
      }
    }
  }
  add_ridged_roof(writer, world_from_house * upright_frame({0.0, 0.0, size.z()}, 0.0), half.head<2>(), size.z() / 3.0);
}

}  // namespace plumbline
