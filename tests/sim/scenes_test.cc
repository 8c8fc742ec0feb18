#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "sim/ray_scene.h"
#include "sim/scene_library.h"
#include "sim/world.h"
#include "tests/sim/scene_routes.h"

namespace plumbline {
namespace {

using test::points_along;
using test::route_of;
using test::scene_routes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::uint64_t kSeeds[] = {1, 2, 3, 42, 0xffffffffffffffffULL};

/// Kilometres of road are the same again and again to these tests: half a kilometre of them is enough.
SceneValues shortened(const std::string& scene, SceneValues values) {
  constexpr double kLongest_m = 500.0;
  for (const SceneInfo& info : scene_library()) {
    for (const SceneParameter& parameter : info.parameters) {
      if (info.name != scene || parameter.name != "length_m" || parameter.max < 1000.0) continue;
      const double asked = values.contains("length_m") ? values["length_m"] : parameter.default_value;
      values["length_m"] = std::clamp(asked, parameter.min, std::max(kLongest_m, parameter.min));
    }
  }
  return values;
}

SceneDescription make_scene(const std::string& scene, const SceneValues& values, std::uint64_t seed) {
  return build_scene(scene, shortened(scene, values), seed);
}

World make_world(const std::string& scene, const SceneValues& values, std::uint64_t seed) {
  return World::from_scene(make_scene(scene, values, seed), seed);
}

bool same_meshes(const std::vector<SceneMesh>& one, const std::vector<SceneMesh>& two) {
  return std::equal(one.begin(), one.end(), two.begin(), two.end(), [](const SceneMesh& a, const SceneMesh& b) {
    return a.name == b.name && a.material == b.material && a.origin == b.origin && a.vertices == b.vertices &&
           a.triangles == b.triangles;
  });
}

SceneValues full_of_clutter(const std::string& scene) {
  if (scene == "garage" || scene == "hall") return {{"clutter", 1.0}};
  return {};
}

/// Distance from a point to a geom; a curved geom counts as the box around it, which errs on the safe side.
double distance_to(const World& world, int geom, const Eigen::Vector3d& point) {
  const mjModel& model = world.model();
  const mjtNum* size = model.geom_size + 3 * geom;
  Eigen::Vector3d half(size[0], size[1], size[2]);
  if (model.geom_type[geom] == mjGEOM_CYLINDER) half = {size[0], size[0], size[1]};
  if (model.geom_type[geom] == mjGEOM_CAPSULE) half = {size[0], size[0], size[1] + size[0]};
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> world_from_geom(world.data().geom_xmat +
                                                                                       9 * geom);
  const Eigen::Map<const Eigen::Vector3d> centre(world.data().geom_xpos + 3 * geom);
  const Eigen::Vector3d in_geom = world_from_geom.transpose() * (point - centre);
  return (in_geom.cwiseAbs() - half).cwiseMax(0.0).norm();
}

double clearance(const World& world, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int geom = 0; geom < world.model().ngeom; ++geom) nearest = std::min(nearest, distance_to(world, geom, point));
  return nearest;
}

struct Hit {
  double range_m = -1.0;  // negative: nothing
  int geom = -1;
};

Hit cast(const World& world, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Hit hit;
  hit.range_m = mj_ray(&world.model(), &world.data(), origin.data(), direction.data(), nullptr, 1, -1, &hit.geom);
  return hit;
}

std::vector<Eigen::Vector3d> sphere_directions(int count) {  // Fibonacci lattice
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double angle = i * M_PI * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

/// The defaults; all at their smallest and at their largest; and each alone at either end.
std::vector<SceneValues> extreme_values(const SceneInfo& scene) {
  std::vector<SceneValues> all(3);
  for (const SceneParameter& parameter : scene.parameters) {
    all[1][parameter.name] = parameter.min;
    all[2][parameter.name] = parameter.max;
    all.push_back({{parameter.name, parameter.min}});
    all.push_back({{parameter.name, parameter.max}});
  }
  return all;
}

TEST(SceneLibrary, SameSeedGivesTheSameBytes) {
  for (const SceneInfo& scene : scene_library()) {
    const SceneDescription one = make_scene(scene.name, {}, 7);
    const SceneDescription two = make_scene(scene.name, {}, 7);
    EXPECT_EQ(one.mjcf, two.mjcf) << scene.name;
    EXPECT_TRUE(same_meshes(one.meshes, two.meshes)) << scene.name;
    ASSERT_EQ(one.lamps.size(), two.lamps.size());
    for (std::size_t i = 0; i < one.lamps.size(); ++i) {
      EXPECT_EQ(one.lamps[i].position, two.lamps[i].position);
      EXPECT_EQ(one.lamps[i].intensity_cd, two.lamps[i].intensity_cd);
    }
  }
}

TEST(SceneLibrary, AnotherSeedGivesAnotherScene) {
  for (const SceneInfo& scene : scene_library()) {
    const SceneDescription one = make_scene(scene.name, {}, 7);
    const SceneDescription two = make_scene(scene.name, {}, 8);
    const bool same_lamps = one.lamps.empty() || one.lamps.front().intensity_cd == two.lamps.front().intensity_cd;
    EXPECT_FALSE(one.mjcf == two.mjcf && same_meshes(one.meshes, two.meshes) && same_lamps) << scene.name;
  }
}

TEST(SceneLibrary, EverySceneCompilesForSeveralSeedsAndExtremeParameters) {
  for (const SceneInfo& scene : scene_library()) {
    for (const std::uint64_t seed : kSeeds) EXPECT_NO_THROW(make_world(scene.name, {}, seed)) << scene.name;
    for (const SceneValues& values : extreme_values(scene)) {
      const World world = make_world(scene.name, values, 1);
      EXPECT_GE(world.model().ngeom, 4) << scene.name;
      EXPECT_TRUE(!world.lamps().empty() || world.ambient_lux() > 0.0) << scene.name;
    }
  }
}

// The renderer draws every triangle near by, a hundred thousand times a scenario. Meshes are batches by themselves.
TEST(SceneLibrary, DefaultScenesHaveAModerateNumberOfGeomsAndSeveralLooks) {
  for (const SceneInfo& scene : scene_library()) {
    const World world = make_world(scene.name, {}, 1);
    const auto* types = world.model().geom_type;
    EXPECT_LT(world.model().ngeom - std::count(types, types + world.model().ngeom, mjGEOM_MESH), 1500) << scene.name;
    EXPECT_GE(world.materials().size(), 2U) << scene.name;
    for (int geom = 0; geom < world.model().ngeom; ++geom) {
      const Material& material = world.materials()[static_cast<std::size_t>(world.material_of(geom))];
      EXPECT_THAT(material.name, ::testing::Not(::testing::StartsWith("rgba"))) << scene.name;
    }
  }
}

/// Whether a route of a scene that is walked is clear at a point: 0.3 m to both sides, and to 1.9 m above.
void expect_walkable(const RayScene& rays, const Eigen::Vector3d& point, const Eigen::Vector3d& along) {
  constexpr double kStepsUp = 0.25;  // what a foot steps over
  const RayHit floor = rays.cast(point + Eigen::Vector3d(0.0, 0.0, kStepsUp), -Eigen::Vector3d::UnitZ(), 0.0, 1.0);
  ASSERT_TRUE(floor.hit) << point.transpose();
  EXPECT_NEAR(floor.range_m, kStepsUp, 0.21) << point.transpose();
  const Eigen::Vector3d right = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  for (const double side : {-0.3, 0.0, 0.3}) {
    const Eigen::Vector3d foot = point + side * right + Eigen::Vector3d(0.0, 0.0, kStepsUp);
    EXPECT_FALSE(rays.cast(foot, Eigen::Vector3d::UnitZ(), 0.0, 1.9 - kStepsUp).hit) << point.transpose();
  }
  for (const double height : {0.4, 1.0, 1.7}) {
    const Eigen::Vector3d left_end = point - 0.3 * right + Eigen::Vector3d(0.0, 0.0, height);
    EXPECT_FALSE(rays.cast(left_end, right, 0.0, 0.6).hit) << point.transpose() << ", at " << height << " m";
  }
}

/// Cars that drive along a route come and go.
SceneValues without_traffic(const SceneInfo& scene, SceneValues values) {
  for (const SceneParameter& parameter : scene.parameters) {
    if (parameter.name == "moving_cars_per_km") values[parameter.name] = 0.0;
  }
  return values;
}

/// Woods grow into their paths at the ends of their parameters: their routes are walked as they are by default.
std::vector<SceneValues> values_to_walk(const SceneInfo& scene) {
  const bool wooded = std::any_of(scene.parameters.begin(), scene.parameters.end(),
                                  [](const SceneParameter& parameter) { return parameter.name == "leaf_density"; });
  return wooded ? std::vector<SceneValues>(1) : extreme_values(scene);
}

TEST(SceneRoutes, EverySceneHasRoutesThatCanBeWalkedOrFlown) {
  for (const SceneInfo& scene : scene_library()) {
    for (const SceneValues& values : values_to_walk(scene)) {
      const World world = make_world(scene.name, without_traffic(scene, values), 3);
      const RayScene rays(world);
      ASSERT_FALSE(world.routes().empty()) << scene.name;
      for (const Route& route : world.routes()) {
        SCOPED_TRACE(scene.name + " " + route.name + " " + (values.empty() ? "" : values.begin()->first));
        ASSERT_GE(route.points.size(), 2U);
        const std::size_t legs = route.points.size() - (route.closed ? 0 : 1);
        for (std::size_t i = 0; i < legs; ++i) {
          const Eigen::Vector3d from = route.points[i];
          const Eigen::Vector3d leg = route.points[(i + 1) % route.points.size()] - from;
          ASSERT_LE(leg.norm(), 5.0);
          ASSERT_FALSE(
              rays.cast(from + Eigen::Vector3d(0.0, 0.0, route.flown ? 0.0 : 1.5), leg.normalized(), 0.0, leg.norm())
                  .hit);
          for (const double share : {0.0, 0.33, 0.67}) {
            if (!route.flown) expect_walkable(rays, from + share * leg, leg);
          }
          if (::testing::Test::HasFailure()) return;
        }
      }
    }
  }
}

TEST(SceneLibrary, EverySceneHasASmallPicture) {
  for (const SceneInfo& scene : scene_library()) {
    const std::filesystem::path picture = std::filesystem::path(PLUMBLINE_PICTURE_DIR) / (scene.name + ".jpg");
    ASSERT_TRUE(std::filesystem::exists(picture)) << picture << " is missing: tools/dev pictures " << scene.name;
    EXPECT_LE(std::filesystem::file_size(picture), 40'000U) << picture;
  }
}

TEST(SceneLibrary, MoreClutterOnlyAddsThings) {
  for (const std::string scene : {"garage", "hall"}) {
    const int empty = make_world(scene, {{"clutter", 0.0}}, 5).model().ngeom;
    const int half = make_world(scene, {{"clutter", 0.5}}, 5).model().ngeom;
    const int full = make_world(scene, {{"clutter", 1.0}}, 5).model().ngeom;
    EXPECT_LT(empty, half) << scene;
    EXPECT_LT(half, full) << scene;
  }
}

TEST(SceneLibrary, ErrorsNameSceneParameterValueAndWhatIsAllowed) {
  const auto expect_error = [](const std::string& scene, const SceneValues& values, auto matcher) {
    EXPECT_THAT([&] { build_scene(scene, values, 1); }, ThrowsMessage<std::invalid_argument>(matcher));
  };
  expect_error("gerage", {}, AllOf(HasSubstr("'gerage'"), HasSubstr("garage, corridor")));
  expect_error("garage", {{"hight_m", 3}}, AllOf(HasSubstr("'hight_m'"), HasSubstr("ceiling_m")));
  expect_error("garage", {{"clutter", 1.5}}, AllOf(HasSubstr("clutter is 1.5"), HasSubstr("0 to 1")));
  expect_error("garage", {{"clutter", std::nan("")}}, HasSubstr("clutter is nan"));
  expect_error("garage", {{"hall_count", 2.5}}, HasSubstr("whole numbers"));
  expect_error("corridor", {{"length_m", 1e300}}, HasSubstr("length_m"));
  expect_error("tunnel", {{"rib_spacing_m", 0.5}}, HasSubstr("rib_spacing_m"));
}

TEST(SceneRoutes, KeepClearOfEverythingForEverySeedAndFullClutter) {
  for (const auto& route : scene_routes()) {
    for (const std::uint64_t seed : kSeeds) {
      const World world = make_world(route.scene, full_of_clutter(route.scene), seed);
      for (const Eigen::Vector3d& point : points_along(route.waypoints, 0.25)) {
        ASSERT_GE(clearance(world, point), 0.8) << route.scene << " seed " << seed << " at " << point.transpose();
      }
    }
  }
}

TEST(SceneRoutes, AreAsLongAsTheScenariosNeed) {
  const auto length_of = [](const std::vector<Eigen::Vector3d>& points) {
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return length;
  };
  EXPECT_GE(length_of(route_of("garage").waypoints), 110.0);
  EXPECT_GE(length_of(route_of("corridor").waypoints), 70.0);
  EXPECT_GE(length_of(route_of("tunnel").waypoints), 60.0);
  EXPECT_GE(length_of(route_of("hall").waypoints), 80.0);
}

// Without clutter, where there is the most to be seen through.
TEST(SceneRoutes, ClosedScenesLetNoRayEscape) {
  const auto directions = sphere_directions(1500);
  for (const std::string scene : {"garage", "corridor", "hall"}) {
    const World world = make_world(scene, {}, 1);
    for (const Eigen::Vector3d& place : points_along(route_of(scene).waypoints, 4.0)) {
      for (const Eigen::Vector3d& direction : directions) {
        ASSERT_GE(cast(world, place, direction).range_m, 0.0) << scene << " at " << place.transpose();
      }
    }
  }
}

// So that a garage walk's error at its end is drift: nothing that was mapped in the first seconds can be seen again.
TEST(Garage, WhatTheFirstElevenMetresSeeIsNotSeenFromTheEnd) {
  const auto points = points_along(route_of("garage").waypoints, 0.5);
  EXPECT_GE((points.back() - points.front()).norm(), 45.0);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const World world = make_world("garage", {{"clutter", 0.0}}, seed);
    for (std::size_t i = 0; i <= 22; i += 2) {
      for (const Eigen::Vector3d& direction : sphere_directions(3000)) {
        const Hit hit = cast(world, points[i], direction);
        const Eigen::Vector3d seen = points[i] + (hit.range_m - 0.02) * direction;
        const Eigen::Vector3d towards = seen - points.back();
        const Hit from_end = cast(world, points.back(), towards.normalized());
        ASSERT_LT(from_end.range_m, towards.norm() - 0.05) << "seed " << seed << ": both see " << seen.transpose();
      }
    }
  }
}

TEST(Garage, DoorsAreWideAndHighEnoughToWalkThrough) {
  const World world = make_world("garage", {}, 1);
  for (const auto& [x, y] : {std::pair{36.1, -4.75}, std::pair{72.3, 4.75}}) {
    const Eigen::Vector3d middle(x, y, 1.0);
    const double left = cast(world, middle, Eigen::Vector3d::UnitY()).range_m;
    const double right = cast(world, middle, -Eigen::Vector3d::UnitY()).range_m;
    const double above = cast(world, middle, Eigen::Vector3d::UnitZ()).range_m;
    EXPECT_GE(left + right, 2.4);
    EXPECT_GE(1.0 + above, 2.3);
  }
}

TEST(Garage, LanesStayFreeInHallsOfAnySize) {
  const double length = 60.0;
  const World world = make_world(
      "garage", {{"hall_length_m", length}, {"hall_width_m", 40}, {"clutter", 1}, {"pillar_spacing_m", 4}}, 9);
  for (double x = 2.0; x <= length - 2.0; x += 0.5) {
    for (const double y : {-4.75, 4.75}) EXPECT_GE(clearance(world, {x, y, 1.2}), 1.1) << x << ", " << y;
  }
  for (double y = -6.5; y <= 6.5; y += 0.5) {
    for (const double x : {3.5, length - 3.5}) EXPECT_GE(clearance(world, {x, y, 1.2}), 1.1) << x << ", " << y;
  }
}

// The tessellation's faces lie up to 0.03 % of the radius inside the sphere.
TEST(Sphere, EveryRayFromTheMiddleMeetsItAtItsRadius) {
  const World world = make_world("sphere", {{"radius_m", 20.0}}, 1);
  const RayScene rays(world);
  for (const Eigen::Vector3d& direction : sphere_directions(5000)) {
    const RayHit hit = rays.cast(Eigen::Vector3d::Zero(), direction, 0.0, 100.0);
    ASSERT_TRUE(hit.hit) << direction.transpose();
    EXPECT_NEAR(hit.range_m, 20.0, 20.0 * 1.5e-3);
    EXPECT_LT(hit.normal_in_world.cast<double>().dot(direction), -0.99);
  }
}

TEST(Flat, NothingButGroundStandsWithinTheLandmarksDistance) {
  const World world = make_world("flat", {{"landmark_count", 64}, {"landmark_distance_m", 50}}, 1);
  const RayScene rays(world);
  int landmarks = 0;
  for (int i = 0; i < 3600; ++i) {
    const double azimuth = i * M_PI / 1800.0;
    const RayHit hit = rays.cast({0.0, 0.0, 1.0}, {std::cos(azimuth), std::sin(azimuth), 0.0}, 0.0, 200.0);
    if (!hit.hit) continue;
    EXPECT_GT(hit.range_m, 50.0);
    ++landmarks;
  }
  EXPECT_GT(landmarks, 20);
}

TEST(Hall, DocumentedFlightVolumeIsFree) {
  for (const std::uint64_t seed : kSeeds) {
    const World world = make_world("hall", {{"clutter", 1}, {"column_spacing_m", 3}}, seed);
    for (double x = -16.0; x <= 16.0; x += 2.0) {
      for (double y = -11.0; y <= 11.0; y += 2.0) {
        for (double z = 2.2; z <= 10.0; z += 1.3) ASSERT_GT(clearance(world, {x, y, z}), 0.1);
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
