#include "sim/geom_mesh.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {
namespace {

constexpr double kTolerance_m = 1e-3;
constexpr double kPlaneExtent_m = 40.0;

World world_with(const std::string& geom, const std::string& assets = "") {
  SceneDescription scene;
  scene.mjcf = "<mujoco><asset>" + assets + "</asset><worldbody>" + geom + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

TriangleMesh mesh_in(const World& world) { return mesh_of_geom(world.model(), 0, kTolerance_m, kPlaneExtent_m); }

// Positive when the triangles' winding is counter-clockwise seen from outside.
double enclosed_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

// Every edge borders exactly two triangles, which run along it in opposite directions.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++uses[{t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>((i + 1) % 3)]}];
  }
  for (const auto& [edge, count] : uses) {
    const auto opposite = uses.find({edge.second, edge.first});
    if (count != 1 || opposite == uses.end()) return false;
  }
  return true;
}

double deepest_deviation(const TriangleMesh& mesh, const RayScene& scene) {
  double deepest = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    for (const Eigen::Vector3d& point : {a, Eigen::Vector3d((a + b) / 2), Eigen::Vector3d((b + c) / 2),
                                         Eigen::Vector3d((c + a) / 2), Eigen::Vector3d((a + b + c) / 3)}) {
      deepest = std::max(deepest, scene.distance_to_surface(point, 1.0));
    }
  }
  return deepest;
}

struct Solid {
  const char* type;
  const char* size;
  double volume;
};

class SolidMesh : public ::testing::TestWithParam<Solid> {};

TEST_P(SolidMesh, IsClosedOutwardAndWithinToleranceOfTheSurface) {
  const Solid& solid = GetParam();
  const World world = world_with("<geom type=\"" + std::string(solid.type) + "\" size=\"" + solid.size + "\"/>");
  const TriangleMesh mesh = mesh_in(world);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume(mesh), solid.volume, 0.005 * solid.volume);
  EXPECT_LE(deepest_deviation(mesh, RayScene(world)), kTolerance_m);
  EXPECT_LT(mesh.triangles.size(), 50000U);
}

constexpr double kPi = std::numbers::pi;
INSTANTIATE_TEST_SUITE_P(AllTypes, SolidMesh,
                         ::testing::Values(Solid{"sphere", "1.5", 4.0 / 3.0 * kPi * 1.5 * 1.5 * 1.5},
                                           Solid{"ellipsoid", "0.5 1 2", 4.0 / 3.0 * kPi * 0.5 * 1.0 * 2.0},
                                           Solid{"capsule", "0.5 1", kPi * 0.25 * 2.0 + 4.0 / 3.0 * kPi * 0.125},
                                           Solid{"cylinder", "0.7 1.2", kPi * 0.49 * 2.4}, Solid{"box", "1 2 3", 48.0}),
                         [](const auto& solid) { return std::string(solid.param.type); });

TEST(GeomMesh, PlanesFaceUpAndInfiniteOnesReachTheExtent) {
  const TriangleMesh mesh = mesh_in(world_with(R"(<geom type="plane" size="3 0 1"/>)"));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  Eigen::AlignedBox3f bounds;
  for (const auto& vertex : mesh.vertices) bounds.extend(vertex);
  EXPECT_EQ(bounds.max(), Eigen::Vector3f(3.0F, 40.0F, 0.0F));
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f normal =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_GT(normal.z(), 0.0F);
  }
}

TEST(GeomMesh, AFlatHeightFieldIsItsBaseBox) {
  const TriangleMesh mesh = mesh_in(
      world_with(R"(<geom type="hfield" hfield="h"/>)", R"(<hfield name="h" nrow="4" ncol="6" size="3 2 1 0.5"/>)"));
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume(mesh), 6.0 * 4.0 * 0.5, 1e-5);
}

TEST(GeomMesh, AMeshIsThatOfTheCompiledModel) {
  const World world = world_with(R"(<geom type="mesh" mesh="m"/>)",
                                 R"(<mesh name="m" vertex="0 0 0 2 0 0 0 3 0 0 0 4" face="0 2 1 0 1 3 0 3 2 1 2 3"/>)");
  const TriangleMesh mesh = mesh_in(world);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume(mesh), 4.0, 1e-5);
}

TEST(GeomMesh, AToleranceOfZeroIsRefused) {
  const World world = world_with(R"(<geom type="sphere" size="1"/>)");
  EXPECT_THROW(mesh_of_geom(world.model(), 0, 0.0, kPlaneExtent_m), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
