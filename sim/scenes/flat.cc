#include "sim/scenes/flat.h"

#include <cmath>

#include "sim/scenes/open_ground.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/routes.h"

namespace plumbline {
namespace {

constexpr double kReachM = 300.0;
constexpr double kPatchedM = 80.0;

// Blocks and masts at random angles, up to a fifth farther off than the nearest.
void add_landmarks(MjcfWriter& writer, int count, double distance, std::uint64_t seed) {
  for (int i = 0; i < count; ++i) {
    RandomStream stream(seed, "flat/landmark" + std::to_string(i));
    const double angle = 2.0 * M_PI * (i + stream.uniform(-0.3, 0.3)) / count;
    constexpr double kHalfM = 1.5;
    const double away = distance * stream.uniform(1.0, 1.2) + 2.0 * kHalfM;
    const Pose frame = upright_frame({away * std::cos(angle), away * std::sin(angle), 0.0}, stream.uniform(0.0, M_PI));
    if (stream.uniform() < 0.5) {
      const Eigen::Vector3d half(stream.uniform(0.6, kHalfM), stream.uniform(0.6, kHalfM), 0.0);
      writer.box(pick(stream, wall_materials()), -half, half + Eigen::Vector3d(0.0, 0.0, stream.uniform(2.5, 6.0)),
                 frame);
    } else {
      writer.cylinder(pick(stream, barrel_materials()), {0.0, 0.0, 0.0}, {0.0, 0.0, stream.uniform(4.0, 9.0)},
                      stream.uniform(0.15, 0.4), frame);
    }
  }
}

SceneDescription build_flat(const SceneValues& values, std::uint64_t world_seed) {
  MjcfWriter writer;
  RandomStream ground(world_seed, "flat/ground");
  const Eigen::Vector2d corner = Eigen::Vector2d::Constant(kPatchedM);
  add_open_ground(writer, ground, -corner, corner, {"asphalt_worn", "asphalt", "gravel_path", "floor_screed"}, kReachM);
  add_landmarks(writer, static_cast<int>(std::lround(values.at("landmark_count"))), values.at("landmark_distance_m"),
                world_seed);
  SceneDescription scene = writer.finish("flat", scene_palette(), 0.0, 0.0);
  light_by_day(scene);
  const double half = values.at("route_m") / 8.0;
  scene.routes = {rectangular_route("square", Eigen::Vector3d::Zero(), {half, half}, half / 4.0)};
  return scene;
}

}  // namespace

SceneInfo flat_scene() {
  return {.name = "flat",
          .summary = "level ground and nothing else, but for landmarks far off",
          .parameters = {{"landmark_count", 0, 0, 64, "blocks and masts around", true},
                         {"landmark_distance_m", 60, 40, 250, "of the nearest, from the middle"},
                         {"route_m", 120, 20, 200, "of the square that the route follows"}},
          .build = build_flat,
          .usual_lux = kDaylightLux};
}

}  // namespace plumbline
