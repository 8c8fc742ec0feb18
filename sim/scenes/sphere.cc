#include "sim/scenes/sphere.h"

#include <array>
#include <string>

#include "sim/scenes/mesh_builder.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/routes.h"

namespace plumbline {
namespace {

constexpr int kHalvings = 5;  // of the octahedron's edges: at 10 m, flat faces come 3 mm closer than the corners

using Corners = std::array<Eigen::Vector3d, 3>;

// Corners stay on the unit sphere; they run clockwise seen from outside, so that the faces look inwards.
void add_face(MeshBuilder& builder, const std::string& material, const Corners& corners, double radius, int halvings) {
  const auto& [a, b, c] = corners;
  if (halvings == 0) return builder.triangle(material, radius * a, radius * b, radius * c);
  const Eigen::Vector3d ab = (a + b).normalized();
  const Eigen::Vector3d bc = (b + c).normalized();
  const Eigen::Vector3d ca = (c + a).normalized();
  for (const Corners& part : {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{ab, bc, ca}}) {
    add_face(builder, material, part, radius, halvings - 1);
  }
}

SceneDescription build_sphere(const SceneValues& values, std::uint64_t world_seed) {
  const double radius = values.at("radius_m");
  const bool patterned = values.at("patterned") > 0.5;
  RandomStream stream(world_seed, "sphere");
  MeshBuilder builder;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        const Eigen::Vector3d a = x * Eigen::Vector3d::UnitX();
        const Eigen::Vector3d b = y * Eigen::Vector3d::UnitY();
        const Eigen::Vector3d c = z * Eigen::Vector3d::UnitZ();
        const std::string material = pick(stream, wall_materials());
        const bool outwards = x * y * z > 0.0;
        add_face(builder, patterned ? material : "blank_wall", outwards ? Corners{a, c, b} : Corners{a, b, c}, radius,
                 kHalvings);
      }
    }
  }
  MjcfWriter writer;
  for (SceneMesh& mesh : builder.take()) writer.mesh(std::move(mesh));
  writer.lamp({Eigen::Vector3d::Zero(), stream.uniform(3.0, 4.0) * radius * radius, 4.0 * radius});
  SceneDescription scene = writer.finish("sphere", scene_palette(), 30.0, 0.0);
  const double half = 0.25 * radius;
  scene.routes = {flown(rectangular_route("in_the_air", {0.0, 0.0, 0.1 * radius}, {half, half}, 0.4 * half))};
  return scene;
}

}  // namespace

SceneInfo sphere_scene() {
  return {.name = "sphere",
          .summary = "inside of a sphere: a lidar cannot tell how it is turned about the middle",
          .parameters = {{"radius_m", 10, 4, 60, "of the sphere about the origin"},
                         {"patterned", 1, 0, 1, "0: nothing for a camera to see either", true}},
          .build = build_sphere};
}

}  // namespace plumbline
