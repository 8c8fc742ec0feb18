#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/ray_scene.h"

namespace plumbline {
namespace {

World world_around(const std::string& geoms) {
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody>" + geoms + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

TEST(DistanceToSurface, IsThatOfTheNearestSurface) {
  const World world = world_around(R"(<geom type="box" size="1 1 1"/><geom type="sphere" size="1" pos="10 0 0"/>
      <geom type="capsule" size="0.5 1" pos="20 0 0"/><geom type="cylinder" size="1 2" pos="30 0 0"/>
      <geom type="ellipsoid" size="1 2 3" pos="40 0 0"/><geom type="plane" size="1 1 1" pos="50 0 0"/>
      <geom type="plane" size="0 0 1" pos="0 0 -20"/>)");
  const RayScene scene(world);
  const auto expect = [&](double x, double y, double z, double distance_m) {
    EXPECT_NEAR(scene.distance_to_surface({x, y, z}, 5.0), distance_m, 1e-9) << x << ' ' << y << ' ' << z;
  };
  expect(0, 0, 3, 2.0);  // box: face, edge, corner, inside
  expect(0, 2, 3, std::sqrt(5.0));
  expect(2, 2, 2, std::sqrt(3.0));
  expect(0.2, 0.1, 0.7, 0.3);
  expect(10, 0, 1.5, 0.5);  // sphere
  expect(10, 0.25, 0, 0.75);
  expect(20, 1, 0.5, 0.5);  // capsule: side, cap
  expect(20, 0, 2.0, 0.5);
  expect(30, 0, 2.5, 0.5);  // cylinder: cap, rim, inside
  expect(30, 4, 6, 5.0);
  expect(30, 0.9, 0, 0.1);
  expect(40, 0, 4, 1.0);  // ellipsoid: along an axis, from its centre
  expect(40, 0, 0, 1.0);
  expect(50, 0, -0.5, 0.5);  // planes
  expect(50, 0, 2, 2.0);
  expect(50, 3, 0, 2.0);
  expect(100, 100, -18, 2.0);
  expect(100, 100, 0, 5.0);  // the limit
}

TEST(DistanceToSurface, OfAnEllipsoidIsThatOfItsNearestSample) {
  const World world = world_around(R"(<geom type="ellipsoid" size="0.5 1 2"/>)");
  const RayScene scene(world);
  RandomStream stream(8, "ellipsoid");
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d point = Eigen::Vector3d(stream.uniform(-2, 2), stream.uniform(-2, 2), stream.uniform(-2, 2));
    double nearest = 1e3;
    for (int theta = 0; theta <= 400; ++theta) {
      for (int phi = 0; phi < 800; ++phi) {
        const double t = std::numbers::pi * theta / 400.0;
        const double p = std::numbers::pi * phi / 400.0;
        const Eigen::Vector3d on_surface(0.5 * std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), 2.0 * std::cos(t));
        nearest = std::min(nearest, (on_surface - point).norm());
      }
    }
    const double ours = scene.distance_to_surface(point, 10.0);
    EXPECT_LE(ours, nearest + 1e-9);
    EXPECT_NEAR(ours, nearest, 3e-3);
  }
}

TEST(DistanceToSurface, WithNothingAroundIsTheLimit) {
  const World world = world_around("");
  EXPECT_EQ(RayScene(world).distance_to_surface({0, 0, 0}, 2.0), 2.0);
}

TEST(DistanceToSurface, OfManyIsTheLeastOfEachAlone) {
  RandomStream stream(1, "clutter");
  std::string geoms;
  std::vector<RayScene> alone;
  for (int i = 0; i < 40; ++i) {
    std::string place;
    for (int axis = 0; axis < 3; ++axis) place += std::to_string(stream.uniform(-5.0, 5.0)) + " ";
    const std::string geom = std::string("<geom type=\"") + (i % 2 == 0 ? "box" : "capsule") +
                             "\" size=\"0.2 0.3 0.4\" euler=\"" + place + "\" pos=\"" + place + "\"/>";
    alone.emplace_back(world_around(geom));
    geoms += geom;
  }
  const World world = world_around(geoms);
  const RayScene together(world);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point(stream.uniform(-6, 6), stream.uniform(-6, 6), stream.uniform(-6, 6));
    double nearest = 4.0;
    for (const RayScene& scene : alone) nearest = std::min(nearest, scene.distance_to_surface(point, 4.0));
    EXPECT_NEAR(together.distance_to_surface(point, 4.0), nearest, 1e-9);
  }
}

}  // namespace
}  // namespace plumbline
