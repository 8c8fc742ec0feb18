#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "sim/ray_scene.h"
#include "sim/scene_library.h"
#include "sim/scenes/routes.h"
#include "sim/world.h"

namespace plumbline {
namespace {

constexpr double kStorey_m = 2.8;

World make_house(const SceneValues& values = {}) { return World::from_scene(build_scene("house", values, 1), 1); }

const Route& route_of(const World& world, const std::string& name) {
  for (const Route& route : world.routes()) {
    if (route.name == name) return route;
  }
  throw std::invalid_argument("no route " + name);
}

double floor_below(const RayScene& rays, const Eigen::Vector3d& place) {
  const RayHit hit = rays.cast(place + 0.5 * Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ(), 0.0, 5.0);
  return hit.hit ? place.z() + 0.5 - hit.range_m : -100.0;
}

// A cast is exact to some 1e-6 m at these distances.
TEST(House, HasFourLevelsAStoreyApart) {
  for (const double storey : {2.6, kStorey_m, 3.4}) {
    const World world = make_house({{"storey_m", storey}});
    const RayScene rays(world);
    for (int level = 0; level < 4; ++level) {
      const Eigen::Vector3d hall(-5.5, -0.5, 0.15 + (level - 1) * storey);
      EXPECT_NEAR(floor_below(rays, hall), hall.z(), 1e-4);
      const RayHit ceiling = rays.cast(hall + Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), 0.0, 5.0);
      ASSERT_TRUE(ceiling.hit);
      EXPECT_NEAR(1.0 + ceiling.range_m, storey - 0.25, 1e-4);
    }
  }
}

// Along the middle of each flight, in steps shorter than a tread, from floor to floor.
TEST(House, StairsRiseInStepsOfAtMostTwentyCentimetres) {
  for (const double storey : {2.6, kStorey_m, 3.4}) {
    const World world = make_house({{"storey_m", storey}});
    const RayScene rays(world);
    for (int level = 0; level < 3; ++level) {
      double height = 0.15 + (level - 1) * storey;
      const double top = height + storey;
      int risers = 0;
      for (double x = -3.0; x <= 3.0; x += 0.05) {
        const double next = floor_below(rays, {x, 1.55, height});
        EXPECT_GE(next, height - 1e-4) << "at " << x;
        EXPECT_LE(next - height, 0.2) << "at " << x;
        if (next - height > 0.05) ++risers;
        height = next;
      }
      EXPECT_NEAR(height, top, 1e-4);
      EXPECT_EQ(risers, static_cast<int>(std::ceil(storey / 0.18)));
    }
  }
}

TEST(House, FirstRouteVisitsAllLevelsAndComesBack) {
  const World world = make_house();
  const Route& route = world.routes().front();
  EXPECT_EQ(route.name, "all_floors");
  std::set<int> levels;
  for (const Eigen::Vector3d& point : route.points) {
    const double level = (point.z() - 0.15) / kStorey_m + 1.0;
    if (std::abs(level - std::round(level)) < 1e-6) levels.insert(static_cast<int>(std::round(level)));
  }
  EXPECT_EQ(levels, (std::set<int>{0, 1, 2, 3}));
  EXPECT_LT((route.points.front() - route.points.back()).norm(), 1e-6);
  EXPECT_GT(length_of(route), 150.0);
}

TEST(House, LoopOfTheFirstFloorStaysThereAndIsSomeSixtyMetresLong) {
  const World world = make_house();
  const Route& route = route_of(world, "first_floor");
  EXPECT_TRUE(route.closed);
  EXPECT_NEAR(length_of(route), 60.0, 5.0);
  for (const Eigen::Vector3d& point : route.points) EXPECT_NEAR(point.z(), 0.15, 1e-9);
}

TEST(House, WayAroundSeesTheHouseOnItsLeftAllTheWay) {
  const World world = make_house();
  const RayScene rays(world);
  const Route& route = route_of(world, "exterior");
  EXPECT_TRUE(route.closed);
  for (const Eigen::Vector3d& point : route.points) {
    EXPECT_NEAR(floor_below(rays, point), 0.0, 1e-4);
    const Eigen::Vector3d eye = point + 3.0 * Eigen::Vector3d::UnitZ();
    const RayHit wall = rays.cast(eye, Eigen::Vector3d(-point.x(), -point.y(), 0.0).normalized(), 0.0, 8.0);
    EXPECT_TRUE(wall.hit) << point.transpose();
  }
}

TEST(House, MoreFurnitureAddsThings) {
  const std::size_t empty = build_scene("house", {{"furniture", 0.0}}, 1).mjcf.size();
  const std::size_t usual = build_scene("house", {}, 1).mjcf.size();
  const std::size_t full = build_scene("house", {{"furniture", 1.0}}, 1).mjcf.size();
  EXPECT_LT(empty, usual);
  EXPECT_LT(usual, full);
}

}  // namespace
}  // namespace plumbline
