// Windows of a large world and movers: a ray's answer is that of the whole world, wherever it is asked.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <future>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/mover_path.h"
#include "sim/random_stream.h"
#include "sim/ray_scene.h"
#include "sim/scenes/mesh_builder.h"

namespace plumbline {
namespace {

constexpr double kReach_m = 100.0;
constexpr double kLength_m = 9300.0;

/// Ground, walls of boxes and some spheres along x: too long for one Embree scene.
World long_world() {
  MeshBuilder builder;
  RandomStream stream(1, "boxes");
  builder.terrain("ground", {0, -40}, {kLength_m, 40}, 20.0, [](double x, double y) { return std::sin(0.1 * x + y); });
  for (double x = 0.0; x < kLength_m; x += 12.0) {
    const double y = stream.uniform(8.0, 30.0) * (stream.uniform() < 0.5 ? -1.0 : 1.0);
    builder.box("wall", {x, y - 2, -2}, {x + stream.uniform(2, 9), y + 2, stream.uniform(2, 12)});
  }
  SceneDescription scene;
  std::string spheres;
  for (double x = 50.0; x < kLength_m; x += 150.0) {
    spheres += "<geom type=\"sphere\" size=\"1.5\" pos=\"" + std::to_string(x) + " 3 4\"/>";
  }
  scene.mjcf = "<mujoco><worldbody>" + spheres + "</worldbody></mujoco>";
  scene.materials = {{.name = "ground"}, {.name = "wall"}};
  scene.meshes = builder.take();
  return World::from_scene(scene, 1);
}

Eigen::Vector3d drawn_direction(RandomStream& stream) {
  return Eigen::Vector3d(stream.gaussian(), stream.gaussian(), 0.4 * stream.gaussian()).normalized();
}

TEST(RayWindow, SeesAllWithinItsReachAnywhereInALargeWorld) {
  const World world = long_world();
  const RayScene rays(world);
  RandomStream stream(2, "rays");
  int hits = 0;
  int disagree = 0;
  for (const double x : {10.0, 4000.0, 9200.0}) {
    const Eigen::Vector3d place(x, 0, 3);
    const RayWindow window = rays.window(place, kReach_m);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d origin = place + RayWindow::kSlack_m * Eigen::Vector3d(stream.uniform(-0.9, 0.9), 0.2, 0.1);
      const Eigen::Vector3d direction = drawn_direction(stream);
      int geom = -1;
      const double range =
          mj_ray(&world.model(), &world.data(), origin.data(), direction.data(), nullptr, 1, -1, &geom);
      const RayHit hit = window.cast(origin, direction, 0.0, kReach_m, 0.0);
      const bool seen = geom >= 0 && range <= kReach_m;
      if (hit.hit != seen || (seen && hit.geom != geom)) {
        ++disagree;
      } else if (seen) {
        ++hits;
        EXPECT_NEAR(hit.range_m, range, 1e-4);
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_LE(disagree, 1);  // through an edge
}

/// Things of all kinds: meshes and shapes in closed form, coplanar and crossing, a plane, and a van that drives.
World crowded_yard() {
  RandomStream stream(5, "yard");
  const auto place = [&](double low, double high) {
    return std::to_string(stream.uniform(-20, 20)) + ' ' + std::to_string(stream.uniform(-20, 20)) + ' ' +
           std::to_string(stream.uniform(low, high));
  };
  std::string geoms = "<geom type=\"plane\" size=\"0 0 1\"/>";
  for (int i = 0; i < 60; ++i) {
    geoms += "<geom type=\"box\" size=\".3 .4 2\" pos=\"" + place(0, 2) + "\"/>";
    geoms += "<geom type=\"box\" size=\"2 .4 .5\" pos=\"" + std::to_string(stream.integer(-15, 15)) + " 9 .5\"/>";
    geoms += "<geom type=\"sphere\" size=\".5\" pos=\"" + place(0, 4) + "\"/>";
    geoms += "<geom type=\"capsule\" size=\".2 1\" euler=\"40 20 0\" pos=\"" + place(0, 4) + "\"/>";
  }
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody>" + geoms +
               R"(<body name="van" mocap="true" pos="0 -500 0"><geom type="box" size="2 1 1" pos="0 0 1"/></body>
               </worldbody></mujoco>)";
  scene.movers = {{"van", {"lane", {{-20, -4, 0}, {20, -4, 0}}, false}, 10.0, 0.0}};
  return World::from_scene(scene, 1);
}

void expect_same(const RayHit& hit, const RayHit& expected) {
  EXPECT_EQ(hit.hit, expected.hit);
  EXPECT_EQ(hit.geom, expected.geom);
  EXPECT_EQ(hit.range_m, expected.range_m);
  EXPECT_EQ(hit.normal_in_world, expected.normal_in_world);
}

// Side by side as a lidar's, and at all angles; also along the lines in which surfaces meet.
TEST(RayWindow, RaysInAPacketHitWhatTheyHitAlone) {
  const World world = crowded_yard();
  const RayScene rays(world);
  const RayWindow window = rays.window({0, 0, 1.5}, 30.0, 2.0);
  RandomStream stream(6, "rays");
  std::map<int, int> hits_of_geom;
  for (int i = 0; i < 6000; ++i) {
    RayPacket packet;
    packet.size = static_cast<std::size_t>(stream.integer(1, static_cast<int>(RayPacket::kMost)));
    const double spread = i % 3 == 0 ? 1.0 : 0.003;
    const Eigen::Vector3d ahead = drawn_direction(stream);
    for (std::size_t k = 0; k < packet.size; ++k) {
      packet.origins[k] = Eigen::Vector3d(0, 0.01 * stream.uniform(), 1.5);
      packet.directions[k] = (ahead + spread * drawn_direction(stream)).normalized();
      packet.times_s[k] = stream.uniform(1.6, 2.4);
    }
    if (i % 4 == 0) {  // at the foot of a row of boxes
      packet.origins[0] = {0.0, 0.0, 1.5};
      packet.directions[0] = Eigen::Vector3d(stream.uniform(-10, 10), 8.6, -1.5).normalized();
    }
    std::array<RayHit, RayPacket::kMost> hits;
    window.cast(packet, 0.0, 30.0, hits);
    for (std::size_t k = 0; k < packet.size; ++k) {
      expect_same(hits[k], window.cast(packet.origins[k], packet.directions[k], 0.0, 30.0, packet.times_s[k]));
      if (hits[k].hit) ++hits_of_geom[hits[k].geom];
    }
    ASSERT_FALSE(HasFailure()) << "packet " << i;
  }
  EXPECT_GT(hits_of_geom.size(), 100U);
  EXPECT_GT(hits_of_geom[world.geom_count() - 1], 50) << "the van";
}

// The wall 9 km down the street, past all windows between.
TEST(RayScene, LongRaysGoThroughALargeWorld) {
  SceneDescription scene;
  scene.mjcf = R"(<mujoco><worldbody><geom type="box" size="1 1 1" pos="-5 0 -5"/>
                  <geom type="box" size="1 5 5" pos="9000 0 0"/></worldbody></mujoco>)";
  const World world = World::from_scene(scene, 1);
  const RayHit hit = RayScene(world).cast({0, 0, 0}, Eigen::Vector3d::UnitX(), 0.0, 2e4);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.range_m, 8999.0, 1e-6);
}

TEST(RayWindow, AnswersDoNotDependOnWhatWasAskedBefore) {
  const World world = long_world();
  const auto ranges = [](const RayScene& rays, double x) {
    const RayWindow window = rays.window({x, 0, 3}, kReach_m);
    RandomStream stream(3, "rays");
    std::vector<double> all;
    for (int i = 0; i < 500; ++i) {
      all.push_back(window.cast({x, 0, 3}, drawn_direction(stream), 0.0, kReach_m, 0.0).range_m);
    }
    return all;
  };
  const RayScene fresh(world);
  const std::vector<double> expected = ranges(fresh, 5000.0);
  const RayScene used(world);
  for (double x = 0.0; x < 2000.0; x += 100.0) ranges(used, x);
  std::vector<std::future<std::vector<double>>> threads;
  for (int i = 0; i < 4; ++i) threads.push_back(std::async(std::launch::async, [&] { return ranges(used, 5000.0); }));
  for (auto& thread : threads) EXPECT_EQ(thread.get(), expected);
}

TEST(RayScene, DistancesInALargeWorldAreToTheNearestSurface) {
  const World world = long_world();
  const RayScene rays(world);
  RandomStream stream(4, "points");
  for (int i = 0; i < 200; ++i) {  // on the ground, in any order
    const Eigen::Vector3d above(stream.uniform(1, kLength_m - 1), stream.uniform(-5, 5), 30.0);
    const RayHit hit = rays.cast(above, -Eigen::Vector3d::UnitZ(), 0.0, 100.0);
    ASSERT_TRUE(hit.hit);
    const Eigen::Vector3d surface = above - hit.range_m * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(rays.distance_to_surface(surface, 1.0), 0.0, 1e-6);
    EXPECT_NEAR(rays.distance_to_surface(surface - 0.01 * hit.normal_in_world.cast<double>(), 1.0), 0.01, 1e-4);
  }
}

/// A van of 4 m by 2 m by 2 m that drives from (0, 0) along x at 10 m/s, beside a wall.
SceneDescription van_beside_a_wall() {
  SceneDescription scene;
  scene.mjcf = R"(<mujoco><worldbody>
    <geom name="wall" type="box" size="200 0.5 5" pos="0 10.5 0"/>
    <body name="van" mocap="true" pos="0 -500 0"><geom name="hull" type="box" size="2 1 1" pos="0 0 1"/></body>
    </worldbody></mujoco>)";
  scene.movers = {{"van", {"lane", {{0, 0, 0}, {100, 0, 0}}, false}, 10.0, 0.0}};
  return scene;
}

TEST(Movers, AreHitWhereTheyAreAtTheTime) {
  const World world = World::from_scene(van_beside_a_wall(), 1);
  const RayScene rays(world);
  const int hull = mj_name2id(&world.model(), mjOBJ_GEOM, "hull");
  const int wall = mj_name2id(&world.model(), mjOBJ_GEOM, "wall");
  for (const double time_s : {0.0, 1.234, 5.0, 12.5}) {
    const RayWindow window = rays.window({0, -20, 1}, 100.0, time_s);
    const double x = 1.3 + std::fmod(10.0 * time_s, 100.0 - 2.6);  // both axles on the path; and again from the start
    const RayHit side = window.cast({x + 1.9, -20, 1}, Eigen::Vector3d::UnitY(), 0.0, 100.0, time_s);
    EXPECT_EQ(side.geom, hull);
    EXPECT_NEAR(side.range_m, 19.0, 1e-6);
    EXPECT_NEAR(side.normal_in_world.y(), -1.0F, 1e-6F);
    const RayHit beside = window.cast({x + 2.1, -20, 1}, Eigen::Vector3d::UnitY(), 0.0, 100.0, time_s);
    EXPECT_EQ(beside.geom, wall);
    EXPECT_NEAR(beside.range_m, 30.0, 1e-6);
  }
  const RayHit above = rays.cast({0, -500, 10}, -Eigen::Vector3d::UnitZ(), 0.0, 100.0, 0.0);
  EXPECT_FALSE(above.hit) << "a mover is not where its MJCF puts it";
}

TEST(Movers, TurnWithTheirPathAndGoRound) {
  const Mover mover{"van", {"ring", {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}}, true}, 2.0, 5.0};
  const Pose half_way = MoverPath(mover).at(12.5);  // 30 m along
  EXPECT_TRUE(half_way.translation.isApprox(Eigen::Vector3d(20, 10, 0), 1e-9));
  EXPECT_TRUE((half_way.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
  const Pose a_round_later = MoverPath(mover).at(52.5);
  EXPECT_TRUE(a_round_later.translation.isApprox(half_way.translation, 1e-9));
}

TEST(Movers, MustBeMocapBodiesOnAPath) {
  SceneDescription scene = van_beside_a_wall();
  scene.movers.front().body = "bus";
  EXPECT_THROW(World::from_scene(scene, 1), std::invalid_argument);
  scene = van_beside_a_wall();
  scene.movers.front().path.points.resize(1);
  EXPECT_THROW(World::from_scene(scene, 1), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
