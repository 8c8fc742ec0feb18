#include "sim/scene_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/random_stream.h"
#include "sim/ray_scene.h"
#include "sim/scenes/mesh_builder.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kFar_m = 1000.0;

SceneDescription scene_of(std::vector<SceneMesh> meshes) {
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody/></mujoco>";
  scene.materials = {{.name = "grass"}, {.name = "leaf"}, {.name = "wall"}};
  scene.meshes = std::move(meshes);
  return scene;
}

/// Hills, a wall, a leaf and a pole, some kilometres from the origin.
std::vector<SceneMesh> varied_meshes() {
  MeshBuilder builder;
  const Pose there{Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ())), {5000.0, -3000.0, 0.0}};
  builder.terrain("grass", {4900, -3100}, {5100, -2900}, 5.0, [](double x, double y) { return std::sin(x + 0.5 * y); });
  builder.box("wall", {-3, -4, -2}, {3, 4, 8}, there);
  builder.triangle("leaf", {20, 0, 3}, {21, 0, 3}, {20, 0.5, 3.7}, there);
  builder.cylinder("wall", {10, 10, -2}, {10, 10, 6}, 0.3, 9, there);
  return builder.take();
}

TEST(SceneMesh, RaysSeeItAsMujocoDoesFromBothSides) {
  const World world = World::from_scene(scene_of(varied_meshes()), 1);
  const RayScene rays(world);
  RandomStream stream(1, "rays");
  int hits = 0;
  int disagree = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d origin(5000 + stream.uniform(-60, 60), -3000 + stream.uniform(-60, 60),
                                 stream.uniform(-20, 40));
    const Eigen::Vector3d direction =
        Eigen::Vector3d(stream.gaussian(), stream.gaussian(), stream.gaussian()).normalized();
    int geom = -1;
    const double range = mj_ray(&world.model(), &world.data(), origin.data(), direction.data(), nullptr, 1, -1, &geom);
    const RayHit hit = rays.cast(origin, direction, 0.0, kFar_m);
    if (hit.geom != geom) {
      ++disagree;
    } else if (hit.hit) {
      ++hits;
      EXPECT_NEAR(hit.range_m, range, 1e-4);  // a slanting ray over the float32 of MuJoCo's vertices
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LE(disagree, 4);  // through edges
}

TEST(SceneMesh, LooksAsItsMaterialSays) {
  const World world = World::from_scene(scene_of(varied_meshes()), 1);
  const RayHit hit = RayScene(world).cast({5050, -3050, 50}, -Eigen::Vector3d::UnitZ(), 0.0, kFar_m);
  ASSERT_TRUE(hit.hit);
  EXPECT_EQ(world.materials()[static_cast<std::size_t>(world.material_of(hit.geom))].name, "grass");
}

// A flat sheet has no volume, a leaf's three corners are fewer than MuJoCo wants, and both faces share their edges.
TEST(SceneMesh, MayBeFlatOpenAndTwoSided) {
  SceneMesh sheet;
  sheet.name = "sheet";
  sheet.material = "leaf";
  sheet.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  sheet.triangles = {{0, 1, 2}, {2, 1, 0}};
  const World world = World::from_scene(scene_of({sheet}), 1);
  const RayHit hit = RayScene(world).cast({0.2, 0.2, 0.0}, Eigen::Vector3d::UnitZ(), 0.0, kFar_m);
  EXPECT_NEAR(hit.range_m, 1.0, 1e-12);
}

TEST(SceneMesh, KeepsItsVerticesToTheBit) {
  const std::vector<SceneMesh> meshes = varied_meshes();
  const World world = World::from_scene(scene_of(meshes), 1);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const int geom = mj_name2id(&world.model(), mjOBJ_GEOM, mesh_geom_name(i).c_str());
    const float* vertex = world.model().mesh_vert + 3L * world.model().mesh_vertadr[world.model().geom_dataid[geom]];
    EXPECT_EQ(Eigen::Map<const Eigen::Vector3f>(vertex), meshes[i].vertices.front());
    EXPECT_EQ(Eigen::Map<const Eigen::Vector3d>(world.data().geom_xpos + 3L * geom), meshes[i].origin);
  }
}

TEST(SceneMesh, TooManyAreJoinedByMaterialWithoutLosingATriangle) {
  MeshBuilder builder;
  for (int i = 0; i < 100; ++i) {
    for (const char* material : {"grass", "wall"}) builder.box(material, {70.0 * i, 0, 0}, {70.0 * i + 1, 1, 1});
  }
  const std::size_t triangles = builder.triangle_count();
  const std::vector<SceneMesh> joined = joined_meshes(builder.take(), 30);
  EXPECT_LE(joined.size(), 30U);
  std::size_t count = 0;
  for (const SceneMesh& mesh : joined) count += mesh.triangles.size();
  EXPECT_EQ(count, triangles);
  EXPECT_NO_THROW(check_meshes(joined));
  const SceneMesh& last = joined.back();
  EXPECT_NEAR(last.origin.x() + static_cast<double>(last.vertices.back().x()), 70.0 * 99 + 1, 1e-4);
}

TEST(MeshBuilder, SolidsAreClosedAndFaceOutward) {
  const Pose turned{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())), {9, 8, 7}};
  struct Case {
    double volume;
    std::function<void(MeshBuilder&)> build;
  };
  const double hexagon = 1.5 * std::sqrt(3.0);  // area, of radius 1
  for (const Case& solid : {Case{24.0,
                                 [&](MeshBuilder& b) {
                                   b.box("wall", {0, 0, 0}, {2, 3, 4}, turned);
                                 }},
                            Case{2.0 * hexagon,
                                 [&](MeshBuilder& b) {
                                   b.cylinder("wall", {0, 0, 0}, {0, 2, 0}, 1.0, 6, turned);
                                 }},
                            Case{hexagon,
                                 [&](MeshBuilder& b) {
                                   b.frustum("wall", {0, 0, 0}, 1.0, {3, 0, 0}, 0.0, 6, turned);
                                 }},
                            Case{hexagon, [&](MeshBuilder& b) {
                                   b.frustum("wall", {0, 0, 0}, 0.0, {3, 0, 0}, 1.0, 6, turned);
                                 }}}) {
    MeshBuilder builder;
    solid.build(builder);
    // The divergence theorem; the sum depends on the origin unless the surface is closed.
    for (const Eigen::Vector3d& about : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, -3, 2)}) {
      double volume = 0.0;
      for (const SceneMesh& mesh : MeshBuilder(builder).take()) {
        for (const auto& t : mesh.triangles) {
          const auto corner = [&](int i) -> Eigen::Vector3d {
            return mesh.vertices[t[static_cast<std::size_t>(i)]].cast<double>() + mesh.origin - about;
          };
          volume += corner(0).dot(corner(1).cross(corner(2))) / 6.0;
        }
      }
      EXPECT_NEAR(volume, solid.volume, 1e-2);  // corners are rounded to 0.06 mm
    }
  }
}

TEST(SceneMesh, ErrorsNameTheMesh) {
  SceneMesh good;
  good.name = "good";
  good.material = "wall";
  good.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  good.triangles = {{0, 1, 2}};
  const auto message = [](const std::vector<SceneMesh>& meshes, const char* text) {
    EXPECT_THAT([&] { World::from_scene(scene_of(meshes), 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  SceneMesh bad = good;
  bad.triangles = {{0, 1, 3}};
  message({bad}, "mesh 'good': its triangles must refer to its own vertices");
  bad = good;
  bad.vertices[1].y() = std::numeric_limits<float>::quiet_NaN();
  message({bad}, "mesh 'good': its vertices must be finite");
  bad = good;
  bad.triangles.clear();
  message({bad}, "mesh 'good': must have triangles");
  bad = good;
  bad.material = "velvet";
  message({bad}, "mesh 'good' has material 'velvet'");
  message({good, good}, "two meshes have the name 'good'");
}

}  // namespace
}  // namespace plumbline
