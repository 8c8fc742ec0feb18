#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/constants.h"
#include "sim/ray_scene.h"
#include "sim/scene_library.h"
#include "sim/world.h"
#include "tests/sim/scene_routes.h"

namespace plumbline {
namespace {

using test::route_of;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kTunnelReach_m = 100.0;
constexpr double kLidarHeight_m = 1.5;

World make_tunnel(const SceneValues& values, std::uint64_t seed = 1) {
  return World::from_scene(build_scene("tunnel", values, seed), seed);
}

const Route& middle_of(const World& world) { return world.routes().front(); }

Eigen::Vector3d leg(const Route& route, std::size_t i) { return route.points[i + 1] - route.points[i]; }

double heading(const Eigen::Vector3d& direction) { return std::atan2(direction.y(), direction.x()); }

/// Velodyne VLP-16 user manual 63-9243: sixteen lines from -15 to 15 degrees; 0.4 degrees between firings at 20 Hz.
std::vector<Eigen::Vector3d> vlp16_directions() {
  constexpr double kElevations_deg[] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  std::vector<Eigen::Vector3d> directions;
  for (const double elevation_deg : kElevations_deg) {
    const double elevation = elevation_deg * kDegree;
    for (int step = 0; step < 900; ++step) {
      const double azimuth = (0.4 * step + 0.013) * kDegree;
      directions.emplace_back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
    }
  }
  return directions;
}

/// Of the returns within 100 m, the share from surfaces whose normal is within 60 degrees of the x axis.
double axis_facing_share(const RayScene& rays, double x) {
  const Eigen::Vector3d place(x, 0.0, kLidarHeight_m);
  const RayWindow window = rays.window(place, kTunnelReach_m);
  int returns = 0;
  int facing = 0;
  for (const Eigen::Vector3d& direction : vlp16_directions()) {
    const RayHit hit = window.cast(place, direction, 0.0, kTunnelReach_m, 0.0);
    if (!hit.hit) continue;
    ++returns;
    if (std::abs(hit.normal_in_world.x()) > 0.5F) ++facing;
  }
  EXPECT_GT(returns, 10000);
  return static_cast<double>(facing) / returns;
}

double mean_share(const World& world, const std::vector<double>& places) {
  const RayScene rays(world);
  double sum = 0.0;
  for (const double x : places) sum += axis_facing_share(rays, x);
  return sum / static_cast<double>(places.size());
}

const std::vector<double> kAlongTheTunnel = {-73.3, -58.1, -41.9, -27.2, -12.5, 3.7, 16.4, 32.8, 45.1, 59.9, 72.6};

TEST(Tunnel, AlmostNothingFacesAlongIt) {
  for (const double round : {0.0, 1.0}) {
    const World world = make_tunnel({{"round_section", round}});
    const RayScene rays(world);
    for (const double x : {-33.0, -7.3, 0.0, 21.9, 33.0}) {
      EXPECT_LT(axis_facing_share(rays, x), 0.005) << "round " << round << " at x = " << x;
    }
  }
}

TEST(Tunnel, RibsFaceAlongIt) {
  for (const double round : {0.0, 1.0}) {
    const World world = make_tunnel({{"round_section", round}, {"rib_spacing_m", 5}});
    const RayScene rays(world);
    EXPECT_GT(axis_facing_share(rays, 0.0), 0.02) << "round " << round;
  }
}

// One percentage point: what the places that are looked at make of it.
TEST(Tunnel, AsMuchFacesAlongItAsIsAskedFor) {
  for (const double round : {0.0, 1.0}) {
    for (const double percent : {0.0, 3.0, 8.0, 23.0}) {
      const World world = make_tunnel({{"round_section", round}, {"axis_facing_percent", percent}}, 2);
      EXPECT_NEAR(100.0 * mean_share(world, kAlongTheTunnel), percent, 1.0) << "round " << round;
    }
  }
}

TEST(Tunnel, RibsCountAsFacingAlongIt) {
  const World world = make_tunnel({{"rib_spacing_m", 12}, {"axis_facing_percent", 12}}, 3);
  EXPECT_NEAR(100.0 * mean_share(world, kAlongTheTunnel), 12.0, 1.0);
  EXPECT_THAT(
      [] {
        make_tunnel({{"rib_spacing_m", 3}, {"rib_depth_m", 0.4}, {"axis_facing_percent", 1}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("axis_facing_percent")));
}

// Half a percentage point more than for a smooth wall: the steepest of the relief faces along the axis, too.
TEST(Tunnel, ModerateRoughnessKeepsTheShare) {
  const World world = make_tunnel({{"roughness_m", 0.02}, {"axis_facing_percent", 8}});
  EXPECT_NEAR(100.0 * mean_share(world, kAlongTheTunnel), 8.0, 1.5);
}

// What a wall shows to a row of rays, every 2 cm: were two stretches alike, so were their profiles.
TEST(Tunnel, NothingOnItsWallsRepeatsWithinFiftyMetres) {
  const World world = make_tunnel({{"axis_facing_percent", 23}});
  const RayScene rays(world);
  constexpr double kStep_m = 0.02;
  std::vector<double> profile;
  for (double x = -60.0; x < 60.0; x += kStep_m) {
    profile.push_back(rays.cast({x, 0.0, 1.2}, Eigen::Vector3d::UnitY(), 0.0, 10.0).range_m);
  }
  constexpr std::size_t kStretch = 500;  // 10 m: no shorter period could be told from a plain wall
  for (std::size_t shift = 50; shift * kStep_m <= 50.0; ++shift) {
    for (std::size_t from = 0; from + shift + kStretch < profile.size(); from += kStretch) {
      double difference = 0.0;
      for (std::size_t i = from; i < from + kStretch; ++i) difference += std::abs(profile[i + shift] - profile[i]);
      EXPECT_GT(difference / kStretch, 0.01) << "from sample " << from << " by " << shift;
    }
  }
}

TEST(Tunnel, FreeWayIsAsDocumentedWithTheDeepestThings) {
  const World world = make_tunnel({{"axis_facing_percent", 23}});
  const RayScene rays(world);
  for (const double y : {-1.25, 1.25}) {
    for (const double z : {0.2, 1.0, 1.9}) {
      EXPECT_FALSE(rays.cast({-130.0, y, z}, Eigen::Vector3d::UnitX(), 0.0, 260.0).hit) << y << ", " << z;
    }
  }
}

// The ends are out of a 100 m lidar's reach over the whole drive, and there is nothing beyond them.
TEST(Tunnel, IsOpenAtFarEnds) {
  const World world = make_tunnel({});
  const RayScene rays(world);
  for (const Eigen::Vector3d& waypoint : route_of("tunnel").waypoints) EXPECT_LE(std::abs(waypoint.x()) + 100.0, 135.0);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_FALSE(rays.cast({0.0, 0.0, 1.5}, {side, 0.0, 0.0}, 0.0, 1000.0).hit);
    EXPECT_FALSE(rays.cast({side * 140.0, 0.0, 1.5}, -Eigen::Vector3d::UnitZ(), 0.0, 1000.0).hit);
  }
}

// Rays steeper than 8 degrees against the axis: the others leave through the ends.
TEST(Tunnel, LetsNoRayThroughItsLining) {
  for (const SceneValues& values : std::vector<SceneValues>{{},
                                                            {{"round_section", 1}},
                                                            {{"roughness_m", 0.05}},
                                                            {{"round_section", 1}, {"roughness_m", 0.05}},
                                                            {{"bend_deg", 45}},
                                                            {{"bend_deg", 45}, {"round_section", 1}}}) {
    const World world = make_tunnel(values, 3);
    const RayScene rays(world);
    const Route& route = middle_of(world);
    for (const double share : {0.3, 0.78}) {
      const auto i = static_cast<std::size_t>(share * static_cast<double>(route.points.size()));
      const Eigen::Vector3d along = leg(route, i).normalized();
      const Eigen::Vector3d to_far_end = leg(route, route.points.size() - 2).normalized();
      const Eigen::Vector3d place = route.points[i] + Eigen::Vector3d(0.0, 0.2, 1.4);
      constexpr int kRays = 20000;
      for (int k = 0; k < kRays; ++k) {  // a Fibonacci lattice of directions
        const double z = 1.0 - (2.0 * k + 1.0) / kRays;
        const double angle = k * M_PI * (3.0 - std::sqrt(5.0));
        const double r = std::sqrt(1.0 - z * z);
        const Eigen::Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
        if (std::abs(direction.dot(along)) > 0.99 || direction.dot(to_far_end) > 0.99) continue;
        ASSERT_TRUE(rays.cast(place, direction, 0.0, 300.0).hit)
            << place.transpose() << " to " << direction.transpose();
      }
    }
  }
}

// Neighbouring sections of wall differ in their looks alone: their faces are one plane to a tenth of a millimetre.
TEST(Tunnel, SectionsAreFlush) {
  const World world = make_tunnel({});
  const RayScene rays(world);
  std::set<int> sections;
  for (double x = -50.0; x <= 50.0; x += 0.1) {
    const RayHit hit = rays.cast({x, 0.0, 0.7}, Eigen::Vector3d::UnitY(), 0.0, 10.0);
    EXPECT_NEAR(hit.range_m, 2.25, 1e-4);
    sections.insert(world.material_of(hit.geom));
  }
  EXPECT_GE(sections.size(), 5U);
}

// The wall's cells of 0.25 m cut the noise's tops a little; 100 m of it hold some 70 x 2 independent values, whose rms
// is within 10 % of the true one.
TEST(Tunnel, RoughnessIsTheRmsOfTheWallsRelief) {
  for (const double roughness : {0.02, 0.08}) {
    const World world = make_tunnel({{"roughness_m", roughness}});
    const RayScene rays(world);
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (double x = -100.0; x < 100.0; x += 0.11) {
      for (const double z : {0.5, 1.5, 2.5, 3.3}) {
        const RayHit hit = rays.cast({x, 0.0, z}, Eigen::Vector3d::UnitY(), 0.0, 10.0);
        ASSERT_TRUE(hit.hit);
        const double relief = 2.25 - hit.range_m;
        sum += relief;
        squares += relief * relief;
        ++count;
      }
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean, 0.0, 0.15 * roughness);
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), roughness, 0.1 * roughness);
  }
}

TEST(Tunnel, BendTurnsTheRouteByItsAngleAtARadiusThatACarTakes) {
  const World world = make_tunnel({{"length_m", 380}, {"bend_deg", 45}});
  const Route& route = middle_of(world);
  const std::size_t legs = route.points.size() - 1;
  EXPECT_NEAR(heading(leg(route, 0)), 0.0, 1e-9);
  EXPECT_NEAR(heading(leg(route, legs - 1)), 45.0 * kDegree, 1e-9);
  double length = 0.0;
  for (std::size_t i = 0; i < legs; ++i) {
    length += leg(route, i).norm();
    if (i + 1 == legs) continue;
    const double turn = heading(leg(route, i + 1)) - heading(leg(route, i));
    EXPECT_LE(std::abs(turn) / leg(route, i).norm(), 1.0 / 35.0);  // [1/m]
  }
  EXPECT_NEAR(length, 350.0, 0.1);  // 15 m clear of both ends
}

TEST(Tunnel, WayAlongTheRouteIsFreeAndLitThroughTheBend) {
  for (const SceneValues& values :
       std::vector<SceneValues>{{{"length_m", 380}, {"bend_deg", 45}},
                                {{"length_m", 380}, {"bend_deg", 45}, {"axis_facing_percent", 23}},
                                {{"length_m", 380}, {"bend_deg", 90}, {"round_section", 1}, {"roughness_m", 0.05}}}) {
    const World world = make_tunnel(values);
    const RayScene rays(world);
    const Route& route = middle_of(world);
    for (std::size_t i = 0; i + 1 < route.points.size(); ++i) {
      const Eigen::Vector3d along = leg(route, i);
      const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(along).normalized();
      for (const double y : {-0.7, 0.0, 0.7}) {
        for (const double z : {0.2, 1.0, 1.9}) {
          const Eigen::Vector3d from = route.points[i] + y * left + z * Eigen::Vector3d::UnitZ();
          EXPECT_FALSE(rays.cast(from, along.normalized(), 0.0, along.norm()).hit) << from.transpose();
        }
      }
      EXPECT_TRUE(rays.cast(route.points[i] + Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ(), 0.0, 1.01).hit);
      double nearest_lamp_m = 1e9;
      for (const Lamp& lamp : world.lamps()) {
        nearest_lamp_m = std::min(nearest_lamp_m, (lamp.position - route.points[i]).head<2>().norm());
      }
      EXPECT_LT(nearest_lamp_m, 7.0 / 2.0 + 2.0 * 0.8 + 0.5) << "at " << route.points[i].transpose();
    }
  }
}

TEST(Tunnel, BendThatDoesNotFitIsRefused) {
  EXPECT_THAT(
      [] {
        make_tunnel({{"length_m", 60}, {"bend_deg", 90}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("bend_deg")));
}

TEST(Tunnel, SameSeedGivesTheSameBytesWithEverythingInIt) {
  const SceneValues values = {{"length_m", 380}, {"bend_deg", 45}, {"roughness_m", 0.03}, {"axis_facing_percent", 8}};
  const SceneDescription one = build_scene("tunnel", values, 7);
  const SceneDescription two = build_scene("tunnel", values, 7);
  EXPECT_EQ(one.mjcf, two.mjcf);
  ASSERT_EQ(one.meshes.size(), two.meshes.size());
  ASSERT_FALSE(one.meshes.empty());
  for (std::size_t i = 0; i < one.meshes.size(); ++i) {
    EXPECT_EQ(one.meshes[i].name, two.meshes[i].name);
    EXPECT_EQ(one.meshes[i].vertices, two.meshes[i].vertices);
    EXPECT_EQ(one.meshes[i].triangles, two.meshes[i].triangles);
  }
  EXPECT_NE(one.mjcf, build_scene("tunnel", values, 8).mjcf);
}

}  // namespace
}  // namespace plumbline
