#include "sim/ray_scene.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kFar = 1e5;

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

// How the rays' answers compare with mj_ray's.
struct Agreement {
  int rays = 0;
  int both_hit = 0;
  int disagree = 0;
  double worst_range_error_m = 0.0;
  double worst_normal_length_error = 0.0;

  void count(const RayHit& ours, double range_of_mujoco, int geom_of_mujoco) {
    ++rays;
    if (ours.hit != (geom_of_mujoco >= 0) || ours.geom != geom_of_mujoco) {
      ++disagree;
    } else if (ours.hit) {
      ++both_hit;
      worst_range_error_m = std::max(worst_range_error_m, std::abs(ours.range_m - range_of_mujoco));
      worst_normal_length_error = std::max(worst_normal_length_error, std::abs(ours.normal_in_world.norm() - 1.0));
    }
  }
};

double mujoco_range(const World& world, const Ray& ray, int& geom) {
  return mj_ray(&world.model(), &world.data(), ray.origin.data(), ray.direction.data(), nullptr, 1, world.rig_body(),
                &geom);
}

Eigen::Vector3d random_direction(RandomStream& stream) {
  return Eigen::Vector3d(stream.gaussian(), stream.gaussian(), stream.gaussian()).normalized();
}

// From anywhere outside a ball of `radius` about `centre` towards a point a little beyond it at most.
Ray random_ray(RandomStream& stream, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d origin = centre + radius * stream.uniform(1.01, 30.0) * random_direction(stream);
  const Eigen::Vector3d target = centre + radius * stream.uniform(0.0, 1.1) * random_direction(stream);
  return {origin, (target - origin).normalized()};
}

World world_of(const std::string& geoms, const std::string& assets = "") {
  SceneDescription scene;
  scene.mjcf = "<mujoco><asset>" + assets + "</asset><worldbody>" + geoms + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

std::string numbers(const Eigen::VectorXd& values) {
  std::ostringstream text;
  text.precision(17);
  for (const double value : values) text << value << ' ';
  return text.str();
}

std::string random_pose(RandomStream& stream, const Eigen::Vector3d& about) {
  const Eigen::Vector4d quaternion(stream.gaussian(), stream.gaussian(), stream.gaussian(), stream.gaussian());
  return " pos=\"" + numbers(about + 20.0 * random_direction(stream)) + "\" quat=\"" +
         numbers(quaternion.normalized()) + "\" ";
}

std::string random_geom(RandomStream& stream, const std::string& type, const Eigen::Vector3d& about) {
  Eigen::Vector3d size(stream.uniform(0.1, 3.0), stream.uniform(0.1, 3.0), stream.uniform(0.1, 3.0));
  return "<geom type=\"" + type + "\" size=\"" + numbers(size) + "\"" + random_pose(stream, about) + "/>";
}

// Rays at the world's first geom.
void compare(const World& world, double radius, int rays, RandomStream& stream, Agreement& agreement) {
  const RayScene scene(world);
  const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3d>(world.data().geom_xpos);
  for (int i = 0; i < rays; ++i) {
    const Ray ray = random_ray(stream, centre, radius);
    int geom = -1;
    const double range = mujoco_range(world, ray, geom);
    const RayHit ours = scene.cast(ray.origin, ray.direction, 0.0, kFar);
    agreement.count(ours, range, geom);
    EXPECT_LE(ours.normal_in_world.cast<double>().dot(ray.direction), 1e-6);
  }
}

void expect_agreement(const std::string& label, const Agreement& agreement, double tolerance_m) {
  EXPECT_GT(agreement.both_hit, agreement.rays / 20) << label;
  EXPECT_LE(agreement.disagree, agreement.rays / 1000) << label;
  EXPECT_LE(agreement.worst_range_error_m, tolerance_m) << label;
  EXPECT_LE(agreement.worst_normal_length_error, 1e-5) << label;
  std::ostringstream figures;
  figures << agreement.rays << " rays, " << agreement.both_hit << " hits, " << agreement.disagree << " disagree, worst "
          << agreement.worst_range_error_m << " m";
  ::testing::Test::RecordProperty("agreement", figures.str());
}

class PrimitiveRays : public ::testing::TestWithParam<const char*> {};

TEST_P(PrimitiveRays, AgreeWithMujoco) {
  const std::string type = GetParam();
  RandomStream stream(1, type);
  Agreement agreement;
  for (int i = 0; i < 50; ++i) {
    const World world = world_of(random_geom(stream, type, Eigen::Vector3d::Zero()));
    compare(world, world.model().geom_rbound[0] > 0.0 ? world.model().geom_rbound[0] : 4.0, 2000, stream, agreement);
  }
  expect_agreement(type, agreement, 1e-4);
}

TEST_P(PrimitiveRays, AgreeWithMujocoNineKilometresFromTheOrigin) {
  const std::string type = GetParam();
  RandomStream stream(2, type);
  Agreement agreement;
  // A second geom far from the first puts the scene's centre far from both.
  const std::string other_end = R"(<geom type="box" size="1 1 1" pos="-9000 0 0"/>)";
  for (int i = 0; i < 10; ++i) {
    const World world = world_of(random_geom(stream, type, {9000.0, 50.0, 20.0}) + other_end);
    compare(world, world.model().geom_rbound[0] > 0.0 ? world.model().geom_rbound[0] : 4.0, 1000, stream, agreement);
  }
  expect_agreement(type + " at 9 km", agreement, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(AllTypes, PrimitiveRays,
                         ::testing::Values("plane", "sphere", "capsule", "ellipsoid", "cylinder", "box"),
                         [](const auto& type) { return std::string(type.param); });

TEST(RayScene, InfinitePlanesAgreeWithMujoco) {
  RandomStream stream(3, "infinite plane");
  Agreement agreement;
  for (const std::string size : {"0 0 1", "0 2 1", "2 0 1"}) {
    const World world = world_of("<geom type=\"plane\" size=\"" + size + "\"" + random_pose(stream, {0, 0, 0}) + "/>");
    compare(world, 4.0, 30000, stream, agreement);
  }
  expect_agreement("infinite plane", agreement, 1e-4);
}

std::string convex_mesh(RandomStream& stream) {
  Eigen::VectorXd points(3 * 60);
  for (int i = 0; i < 60; ++i) points.segment<3>(3 * i) = stream.uniform(0.5, 2.0) * random_direction(stream);
  return "<mesh name=\"m\" vertex=\"" + numbers(points) + "\"/>";
}

// Off its own centre, which the compiler moves and turns into the mesh's inertial frame.
std::string torus_mesh(double major, double minor) {
  constexpr int kAround = 24;
  constexpr int kTube = 12;
  std::ostringstream vertices;
  std::ostringstream faces;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kTube; ++j) {
      const double u = 2.0 * std::numbers::pi * i / kAround;
      const double v = 2.0 * std::numbers::pi * j / kTube;
      const double radius = major + minor * std::cos(v);
      vertices << 5.0 + radius * std::cos(u) << ' ' << radius * std::sin(u) << ' ' << minor * std::sin(v) << ' ';
      const int a = i * kTube + j;
      const int b = (i + 1) % kAround * kTube + j;
      const int c = (i + 1) % kAround * kTube + (j + 1) % kTube;
      const int d = i * kTube + (j + 1) % kTube;
      faces << a << ' ' << b << ' ' << c << ' ' << a << ' ' << c << ' ' << d << ' ';
    }
  }
  return "<mesh name=\"m\" vertex=\"" + vertices.str() + "\" face=\"" + faces.str() + "\"/>";
}

TEST(RayScene, MeshesAgreeWithMujoco) {
  RandomStream stream(4, "mesh");
  Agreement agreement;
  for (int i = 0; i < 8; ++i) {
    const std::string mesh =
        i % 2 == 0 ? convex_mesh(stream) : torus_mesh(stream.uniform(1.0, 2.0), stream.uniform(0.2, 0.8));
    const World world = world_of("<geom type=\"mesh\" mesh=\"m\"" + random_pose(stream, {0, 0, 0}) + "/>", mesh);
    compare(world, world.model().geom_rbound[0], 2500, stream, agreement);
  }
  expect_agreement("mesh", agreement, 1e-4);
}

// A folder that goes with its last user.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() / ("plumbline_ray_scene_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// MuJoCo's own format: rows, columns, then heights.
void write_height_field(const std::filesystem::path& file, int rows, int columns, RandomStream& stream) {
  std::ofstream out(file, std::ios::binary);
  for (const std::int32_t count : {rows, columns}) out.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (int i = 0; i < rows * columns; ++i) {
    const auto height = static_cast<float>(stream.uniform());
    out.write(reinterpret_cast<const char*>(&height), sizeof height);
  }
}

World world_of_height_field(int rows, int columns, const std::string& pose, RandomStream& stream) {
  const TemporaryFolder folder;
  write_height_field(folder.path() / "field.bin", rows, columns, stream);
  std::ofstream(folder.path() / "world.xml")
      << "<mujoco><asset><hfield name=\"h\" file=\"field.bin\" size=\"3 2 1 0.3\"/></asset><worldbody>"
      << "<geom type=\"hfield\" hfield=\"h\"" << pose << "/></worldbody></mujoco>";
  return World::from_mjcf_file(folder.path() / "world.xml", 1);
}

TEST(RayScene, HeightFieldsAgreeWithMujoco) {
  RandomStream stream(5, "height field");
  Agreement agreement;
  for (int i = 0; i < 6; ++i) {
    const World world = world_of_height_field(7 + i, 7 + i, random_pose(stream, {0, 0, 0}), stream);
    compare(world, 4.0, 5000, stream, agreement);
  }
  expect_agreement("height field", agreement, 1e-4);
}

// From above only: MuJoCo 2.2.2 reads the heights along the +-x sides with a wrong stride unless rows equal columns.
TEST(RayScene, OblongHeightFieldsAgreeWithMujocoFromAbove) {
  RandomStream stream(9, "oblong height field");
  Agreement agreement;
  const World world = world_of_height_field(7, 12, "", stream);
  const RayScene scene(world);
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d origin(stream.uniform(-3.0, 3.0), stream.uniform(-2.0, 2.0), stream.uniform(1.0, 4.0));
    const Eigen::Vector3d target(stream.uniform(-3.0, 3.0), stream.uniform(-2.0, 2.0), 0.0);
    const Ray ray{origin, (target - origin).normalized()};
    int geom = -1;
    const double range = mujoco_range(world, ray, geom);
    agreement.count(scene.cast(ray.origin, ray.direction, 0.0, kFar), range, geom);
  }
  EXPECT_EQ(agreement.both_hit, agreement.rays);
  expect_agreement("oblong height field", agreement, 1e-4);
}

TEST(RayScene, RaysFromInsideASolidLeaveItAsInMujoco) {
  for (const char* type : {"sphere", "capsule", "ellipsoid", "cylinder", "box"}) {
    RandomStream stream(6, type);
    const World world = world_of("<geom type=\"" + std::string(type) + "\" size=\"1.5 1 2\" pos=\"3 4 5\"/>");
    const RayScene scene(world);
    Agreement agreement;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray{Eigen::Vector3d(3, 4, 5) + 0.9 * stream.uniform() * random_direction(stream),
                    random_direction(stream)};
      int geom = -1;
      const double range = mujoco_range(world, ray, geom);
      agreement.count(scene.cast(ray.origin, ray.direction, 0.0, kFar), range, geom);
    }
    EXPECT_EQ(agreement.both_hit, 2000) << type;
    EXPECT_LE(agreement.worst_range_error_m, 1e-4) << type;
  }
}

TEST(RayScene, TheFirstOfManyGeomsIsTheOneThatMujocoSees) {
  RandomStream stream(7, "clutter");
  std::string geoms = R"(<geom type="plane" size="0 0 1" pos="0 0 -25"/>)";
  for (const char* type : {"sphere", "capsule", "ellipsoid", "cylinder", "box", "plane"}) {
    for (int i = 0; i < 20; ++i) geoms += random_geom(stream, type, Eigen::Vector3d::Zero());
  }
  const World world = world_of(geoms);
  const RayScene scene(world);
  Agreement agreement;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{30.0 * random_direction(stream), random_direction(stream)};
    int geom = -1;
    const double range = mujoco_range(world, ray, geom);
    agreement.count(scene.cast(ray.origin, ray.direction, 0.0, kFar), range, geom);
  }
  expect_agreement("clutter", agreement, 1e-4);
}

TEST(RayScene, TransparentGeomsAreNotThere) {
  const World world =
      world_of(R"(<geom type="sphere" size="1" rgba="1 1 1 0"/><geom type="box" size="1 1 1" rgba="1 1 1 0"/>
                                  <geom type="box" size="1 1 1" pos="5 0 0" rgba="1 1 1 0.1"/>)");
  const RayHit hit = RayScene(world).cast({-5, 0, 0}, Eigen::Vector3d::UnitX(), 0.0, kFar);
  EXPECT_EQ(hit.geom, 2);
  EXPECT_NEAR(hit.range_m, 9.0, 1e-9);
}

TEST(RayScene, OnlySurfacesBetweenTheRangesCount) {
  for (const char* type : {"box", "sphere", "cylinder"}) {
    const World world = world_of("<geom type=\"" + std::string(type) + "\" size=\"1 1 1\" pos=\"5 0 0\"/>");
    const RayScene scene(world);
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    EXPECT_NEAR(scene.cast({0, 0, 0}, x, 0.0, 10.0).range_m, 4.0, 1e-9) << type;
    EXPECT_NEAR(scene.cast({0, 0, 0}, x, 4.5, 10.0).range_m, 6.0, 1e-9) << type;
    EXPECT_FALSE(scene.cast({0, 0, 0}, x, 6.5, 10.0).hit) << type;
    EXPECT_FALSE(scene.cast({0, 0, 0}, x, 0.0, 3.5).hit) << type;
  }
}

TEST(RayScene, NormalsFaceTheRay) {
  const World world = world_of(R"(<geom type="box" size="1 1 1"/>)");
  const RayScene scene(world);
  const Eigen::Vector3f from_outside = scene.cast({-5, 0.1, 0.2}, Eigen::Vector3d::UnitX(), 0.0, kFar).normal_in_world;
  const Eigen::Vector3f from_inside = scene.cast({0, 0.1, 0.2}, Eigen::Vector3d::UnitX(), 0.0, kFar).normal_in_world;
  EXPECT_LT((from_outside + Eigen::Vector3f::UnitX()).norm(), 1e-6F);
  EXPECT_LT((from_inside + Eigen::Vector3f::UnitX()).norm(), 1e-6F);
}

TEST(RayScene, ThreadsAndAMovedSceneSeeTheSame) {
  RandomStream stream(10, "threads");
  std::string geoms;
  for (const char* type : {"sphere", "ellipsoid", "box", "box", "capsule"})
    geoms += random_geom(stream, type, {0, 0, 0});
  const World world = world_of(geoms);
  RayScene first(world);
  const RayScene scene(std::move(first));
  const auto ranges = [&] {
    RandomStream rays(11, "rays");
    std::vector<double> all;
    for (int i = 0; i < 20000; ++i) {
      const Ray ray = random_ray(rays, Eigen::Vector3d::Zero(), 25.0);
      all.push_back(scene.cast(ray.origin, ray.direction, 0.0, kFar).range_m);
    }
    return all;
  };
  auto other = std::async(std::launch::async, ranges);
  const std::vector<double> here = ranges();
  EXPECT_EQ(here, other.get());
}

TEST(RayScene, AnEmptyWorldIsHitByNothing) {
  const World world = world_of("");
  EXPECT_FALSE(RayScene(world).cast({0, 0, 0}, Eigen::Vector3d::UnitX(), 0.0, kFar).hit);
}

}  // namespace
}  // namespace plumbline
