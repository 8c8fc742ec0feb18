#include "sim/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <vector>

#include "sim/glare.h"
#include "sim/ray_scene.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

SceneDescription box_on_floor() {
  SceneDescription scene;
  scene.mjcf = R"(<mujoco>
    <asset><material name="asphalt"/><material name="brick"/></asset>
    <worldbody>
      <geom name="floor" type="plane" size="5 5 0.1" material="asphalt"/>
      <geom name="box" type="box" size="0.5 0.5 0.5" pos="2 0 0.5" material="brick"/>
      <geom name="bare" type="sphere" size="0.2" pos="-2 0 0.5" rgba="1 1 1 1"/>
    </worldbody></mujoco>)";
  scene.materials = {{.name = "brick", .pattern = Material::Pattern::kBrick}, {.name = "asphalt"}};
  scene.lamps = {{.position = {0, 0, 3}, .intensity_cd = 100.0}};
  return scene;
}

int geom_named(const World& world, const char* name) { return mj_name2id(&world.model(), mjOBJ_GEOM, name); }

/// A folder of its own for each test, gone afterwards; and the process's working folder while it lives.
class UserFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / ("plumbline-" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
    original_ = fs::current_path();
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path(original_);
    fs::remove_all(folder_);
  }
  fs::path write(const std::string& name, const std::string& content) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << content;
    return folder_ / name;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder_).string());
    }
    return names;
  }

  fs::path folder_;
  fs::path original_;
};

constexpr char kTetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

constexpr char kMeshModel[] = R"(<mujoco>
  <compiler meshdir="meshes"/>
  <asset>
    <material name="painted" rgba="1 0 0 1"/>
    <mesh name="rock" file="rock.obj"/>
  </asset>
  <worldbody>
    <light pos="0 0 4" diffuse="0.5 0.5 0.5"/>
    <geom name="rock" type="mesh" mesh="rock" material="painted"/>
    <geom name="floor" type="plane" size="9 9 0.1"/>
  </worldbody></mujoco>)";

TEST(World, CarriesAMocapRigWithoutGeoms) {
  const World world = World::from_scene(box_on_floor(), 1);
  ASSERT_GT(world.rig_body(), 0);
  EXPECT_GE(world.model().body_mocapid[world.rig_body()], 0);
  EXPECT_EQ(world.model().body_geomnum[world.rig_body()], 0);
}

TEST(World, GeomsLookAsTheirMaterialsSayAndBareOnesAsTheirColour) {
  const World world = World::from_scene(box_on_floor(), 1);
  EXPECT_EQ(world.materials()[static_cast<std::size_t>(world.material_of(geom_named(world, "box")))].pattern,
            Material::Pattern::kBrick);
  EXPECT_EQ(world.materials()[static_cast<std::size_t>(world.material_of(geom_named(world, "floor")))].name, "asphalt");
  EXPECT_FLOAT_EQ(world.materials()[static_cast<std::size_t>(world.material_of(geom_named(world, "bare")))].albedo,
                  1.0F);
}

TEST(World, PosesAreThoseOfTheInitialState) {
  const World world = World::from_scene(box_on_floor(), 1);
  EXPECT_DOUBLE_EQ(world.data().geom_xpos[3 * geom_named(world, "box")], 2.0);
}

TEST(World, NamesAMaterialThatTheSceneForgot) {
  SceneDescription scene = box_on_floor();
  scene.materials.erase(scene.materials.begin());
  EXPECT_THAT([&] { World::from_scene(scene, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("'brick'")));
}

TEST(World, PassesOnMujocosMessage) {
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody><geom type=\"blob\"/></worldbody></mujoco>";
  EXPECT_THAT([&] { World::from_scene(scene, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("blob")));
}

// One lamp 3 m above the floor: straight below it the plate gets ambient + I/9, 2 m aside less. Scaling is linear.
TEST(World, LightLevelScalesLampsAndAmbientAlike) {
  World world = World::from_scene(box_on_floor(), 1);
  const double lamp_over_ambient = world.lamps()[0].intensity_cd / world.ambient_lux();
  world.set_light_level(200.0);
  const double bright = world.lamps()[0].intensity_cd;
  EXPECT_NEAR(bright / world.ambient_lux(), lamp_over_ambient, 1e-9);
  const double below = world.ambient_lux() + bright / 9.0 * lamp_window(3.0, 15.0);
  EXPECT_GT(below, 200.0);
  EXPECT_LT(below, 300.0);
  world.set_light_level(2.0);
  EXPECT_NEAR(world.lamps()[0].intensity_cd, bright / 100.0, 1e-9 * bright);
  EXPECT_THROW(world.set_light_level(-1.0), std::invalid_argument);
}

SceneDescription sunny_day() {
  SceneDescription scene = box_on_floor();
  scene.sun = {Eigen::Vector3d(0.0, 0.6, 0.8), 100'000.0};
  scene.ambient_lux = 20'000.0;
  scene.sky_luminance = 8'000.0;
  return scene;
}

TEST(World, LightLevelByDayScalesSunAmbientAndSkyButNoLamp) {
  World world = World::from_scene(sunny_day(), 1);
  world.set_light_level(1000.0);  // a hundredth of 0.8 * 100000 + 20000 on the ground
  EXPECT_NEAR(world.sun().lux, 1000.0, 1e-6);
  EXPECT_NEAR(world.ambient_lux(), 200.0, 1e-6);
  EXPECT_NEAR(world.sky_luminance(), 80.0, 1e-6);
  EXPECT_EQ(world.lamps()[0].intensity_cd, 100.0);
}

TEST(World, NightLeavesMoonlightAndTheLamps) {
  World world = World::from_scene(sunny_day(), 1);
  world.make_night();
  EXPECT_EQ(world.sun().lux, 0.0);
  EXPECT_NEAR(world.ambient_lux(), 0.1, 1e-12);
  EXPECT_LT(world.sky_luminance(), 0.05);
  EXPECT_EQ(world.lamps()[0].intensity_cd, 100.0);
}

TEST(World, SunAndContrastCanBeSet) {
  World world = World::from_scene(sunny_day(), 1);
  world.set_sun(5.0);
  EXPECT_EQ(world.sun().lux, 5.0);
  EXPECT_THROW(world.set_sun(-1.0), std::invalid_argument);
  world.scale_contrast(0.0);
  for (const Material& material : world.materials()) EXPECT_EQ(material.contrast, 0.0F);
}

TEST(World, GlareLightsSurfacesBesideTheRouteFarBeyondDaylight) {
  SceneDescription scene = box_on_floor();
  EXPECT_THROW(
      {
        const World without_route = World::from_scene(scene, 1);
        glare_lamps(without_route, RayScene(without_route), 1);
      },
      std::invalid_argument);
  scene.mjcf.insert(scene.mjcf.find("</worldbody>"),
                    R"(<geom type="box" size="9 1 3" pos="0 5 0"/><geom type="box" size="9 1 3" pos="0 -5 0"/>)");
  scene.routes = {{"aisle", {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, false}};
  const World world = World::from_scene(scene, 1);
  const RayScene rays(world);
  const std::vector<Lamp> lamps = glare_lamps(world, rays, 5);
  ASSERT_EQ(lamps.size(), 5U);
  for (const Lamp& lamp : lamps) {
    const double distance = rays.distance_to_surface(lamp.position, 10.0);
    EXPECT_NEAR(distance, 0.5, 1e-6);
    EXPECT_GT(lamp.intensity_cd / (distance * distance), 150'000.0);  // more than the sun at noon
  }
}

TEST(World, LampsFadeToNothingAtTheirReach) {
  EXPECT_DOUBLE_EQ(lamp_window(0.0, 10.0), 1.0);
  EXPECT_GT(lamp_window(5.0, 10.0), lamp_window(9.0, 10.0));
  EXPECT_DOUBLE_EQ(lamp_window(10.0, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(lamp_window(20.0, 10.0), 0.0);
}

TEST_F(UserFolder, FileWithAMeshOfItsOwnLoadsFromAnywhere) {
  write("meshes/rock.obj", kTetrahedron);
  const fs::path file = write("a & b <model>.xml", kMeshModel);
  fs::current_path(folder_.parent_path());
  const World world = World::from_mjcf_file(file, 1);
  EXPECT_GE(geom_named(world, "rock"), 0);
  EXPECT_GT(world.rig_body(), 0);
  const Material& painted = world.materials()[static_cast<std::size_t>(world.material_of(geom_named(world, "rock")))];
  EXPECT_EQ(painted.name, "painted");
  EXPECT_NEAR(painted.albedo, 0.2126, 1e-6);  // pure red, Rec. 709
  ASSERT_EQ(world.lamps().size(), 1U);
  EXPECT_DOUBLE_EQ(world.lamps()[0].position.z(), 4.0);
}

TEST_F(UserFolder, FileLoadsByARelativePath) {
  write("meshes/rock.obj", kTetrahedron);
  write("model.xml", kMeshModel);
  EXPECT_GE(geom_named(World::from_mjcf_file("model.xml", 1), "rock"), 0);
}

TEST_F(UserFolder, FileThatIncludesAnotherLoads) {
  write("part.xml", "<mujoco><worldbody><geom name=\"ball\" size=\"1\"/></worldbody></mujoco>");
  const fs::path file = write("model.xml", "<mujoco><include file=\"part.xml\"/></mujoco>");
  EXPECT_GE(geom_named(World::from_mjcf_file(file, 1), "ball"), 0);
}

TEST_F(UserFolder, FileWithoutLightsGetsOneOverhead) {
  const fs::path file = write("dark.xml", "<mujoco><worldbody><geom size=\"1\"/></worldbody></mujoco>");
  World world = World::from_mjcf_file(file, 1);
  ASSERT_EQ(world.lamps().size(), 1U);
  EXPECT_GT(world.lamps()[0].position.z(), 1.0);
}

TEST_F(UserFolder, NothingIsWrittenBesideAUsersFileOrIntoTheWorkingFolder) {
  write("meshes/rock.obj", kTetrahedron);
  const fs::path good = write("good.xml", kMeshModel);
  const fs::path bad = write("bad.xml", "<mujoco><worldbody><geom size=\"nan\"/></worldbody></mujoco>");  // warned of
  const auto before = files();
  World::from_mjcf_file(good, 1);
  EXPECT_THROW(World::from_mjcf_file(bad, 1), std::invalid_argument);
  EXPECT_EQ(files(), before);
}

TEST_F(UserFolder, ErrorsNameTheFileAndTheTrouble) {
  const auto expect_error = [](const fs::path& file, const std::string& trouble) {
    EXPECT_THAT(
        [&] { World::from_mjcf_file(file, 1); },
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(file.string()), HasSubstr(trouble), Not(HasSubstr("\n")))))
        << file;
  };
  expect_error(folder_ / "absent.xml", "no such file");
  expect_error(folder_, "no such file");
  expect_error(write("empty.xml", ""), "empty");
  expect_error(write("broken.xml", "<mujoco><worldbody>"), "XML");
  expect_error(write("robot.xml", "<robot name=\"x\"><link name=\"l\"/></robot>"), "link");
  expect_error(write("blob.xml", "<mujoco><worldbody><geom type=\"blob\"/></worldbody></mujoco>"), "blob");
  expect_error(write("meshless.xml", kMeshModel), "rock.obj");
  expect_error(
      write("textureless.xml", "<mujoco><asset><texture name=\"t\" type=\"2d\" file=\"wood.png\"/></asset></mujoco>"),
      "wood.png");
}

TEST_F(UserFolder, OversizedFilesAreRefusedUnread) {
  const fs::path file = write("huge.xml", " ");
  fs::resize_file(file, (64U << 20U) + 1);  // sparse
  EXPECT_THAT([&] { World::from_mjcf_file(file, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("67108864")));
}

}  // namespace
}  // namespace plumbline
