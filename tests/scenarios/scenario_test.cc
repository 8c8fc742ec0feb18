#include "scenarios/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "scenarios/calibration.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kMotion = "motion: {waypoints: [[0, 0, 1], [10, 0, 1]]}\n";

class ScenarioFile : public testing::Test {
 protected:
  Scenario load(const std::string& text, const std::vector<std::string>& overrides = {},
                std::optional<std::uint64_t> seed = std::nullopt) {
    return load_scenario(files_.write("file.yaml", text), overrides, seed);
  }

  /// What the loader says of a bad file; empty if it finds nothing wrong.
  std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
      load(text, overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryDirectory files_;
};

TEST_F(ScenarioFile, ConditionsOfTheWorld) {
  const WorldConfig plain = load(kMotion).world;
  EXPECT_FALSE(plain.light_lux || plain.sun_lux || plain.night);
  EXPECT_EQ(plain.contrast, 1.0);
  const WorldConfig world =
      load(kMotion, {"world.fog.visibility_m=50", "world.dust.visibility_m=20", "world.rain.mm_per_h=10",
                     "world.light.sun_lux=0", "world.light.night=true", "world.light.rig_lamp_cd=300",
                     "world.light.glare_patches=4", "world.contrast=0"})
          .world;
  EXPECT_EQ(world.atmosphere.fog_visibility_m, 50.0);
  EXPECT_EQ(world.atmosphere.dust_visibility_m, 20.0);
  EXPECT_EQ(world.atmosphere.rain_mm_per_h, 10.0);
  EXPECT_EQ(world.sun_lux, 0.0);
  EXPECT_TRUE(world.night);
  EXPECT_EQ(world.rig_lamp_cd, 300.0);
  EXPECT_EQ(world.glare_patches, 4);
  EXPECT_EQ(world.contrast, 0.0);
}

TEST_F(ScenarioFile, ConditionsOutOfRangeAreRefused) {
  for (const char* condition :
       {"world.fog.visibility_m=0", "world.dust.visibility_m=-1", "world.rain.mm_per_h=1000", "world.light.sun_lux=-1",
        "world.light.night=4", "world.light.rig_lamp_cd=-1", "world.light.glare_patches=1000", "world.contrast=-1"}) {
    EXPECT_THROW(load(kMotion, {condition}), InputError) << condition;
  }
}

TEST_F(ScenarioFile, NeedsNothingButWayPoints) {
  const Scenario scenario = load(kMotion);
  EXPECT_EQ(scenario.name, "file");
  EXPECT_EQ(scenario.seed, 1U);
  EXPECT_EQ(scenario.world.scene, "garage");
  EXPECT_EQ(scenario.estimator_name, "vloam");
  EXPECT_EQ(scenario.rig.lidar.beams.size(), 16U);
  EXPECT_TRUE(scenario.rig.pack_from_lidar.translation.isApprox(Eigen::Vector3d(0, 0, 0.1)));
  EXPECT_TRUE(scenario.rig.camera.pack_from_camera.translation.isApprox(Eigen::Vector3d(0.1, 0, 0)));
}

TEST_F(ScenarioFile, SwitchesEachEffectOfTheLidarOffOnItsOwn) {
  const LidarEffects all = load(kMotion).rig.lidar_effects;
  EXPECT_TRUE(all.range_noise && all.ring_bias && all.drop_out && all.mixed_pixels && all.weather && all.own_body &&
              all.quantisation);
  const std::map<std::string, bool LidarEffects::*> effects = {
      {"range_noise", &LidarEffects::range_noise},  {"ring_bias", &LidarEffects::ring_bias},
      {"drop_out", &LidarEffects::drop_out},        {"mixed_pixels", &LidarEffects::mixed_pixels},
      {"weather", &LidarEffects::weather},          {"own_body", &LidarEffects::own_body},
      {"quantisation", &LidarEffects::quantisation}};
  for (const auto& [key, effect] : effects) {
    const LidarEffects found = load(kMotion, {"rig.lidar.effects." + key + "=false"}).rig.lidar_effects;
    for (const auto& [other, of_other] : effects) EXPECT_EQ(found.*of_other, other != key) << key << ' ' << other;
  }
  const RigConfig ideal = load(kMotion, {"rig.lidar.noise=false", "rig.lidar.returns=dual"}).rig;
  for (const auto& [key, effect] : effects) EXPECT_FALSE(ideal.lidar_effects.*effect) << key;
  EXPECT_EQ(ideal.lidar_returns, LidarReturns::kDual);
}

TEST_F(ScenarioFile, TakesALineScannersSweepAsTheLidarsRate) {
  const RigConfig rig = load(kMotion, {"rig.lidar.model=utm30lx_sweeping"}).rig;
  EXPECT_EQ(messages_per_sweep(rig.lidar), 10);
  const Calibration calibration = calibration_of(rig);
  EXPECT_EQ(calibration.lidar_rings, 40);
  EXPECT_EQ(calibration.lidar_rate_hz, 1.0);
  EXPECT_EQ(calibration.lidar_max_range_m, 30.0);
}

TEST_F(ScenarioFile, ReadsEverySection) {
  const Scenario scenario = load(R"(
seed: 7
world:
  scene: corridor
  seed: 9
  light: {lux: 50, schedule: [{start_s: 1, factor: 0.5}, {start_s: 2, factor: 0}]}
motion:
  speed_mps: 2
  speed_factor: 1.5
  acceleration_mps2: 3
  rest_s: 0
  smoothing_s: 0.5
  attitude: thrust
  gait: {frequency_hz: 2, height_m: 0.01, sway_m: 0.02, roll_deg: 3, pitch_deg: 4}
  oscillations: [{axis: pitch, amplitude_deg: 5, frequency_hz: 2}]
  waypoints: [[0, 0, 1], {at_m: [5, 0, 1], speed_mps: 4}, [9, 0, 1]]
rig:
  decimation: 2
  z_m: 0.4
  pitch_deg: 10
  lidar: {model: vlp16, x_m: 0.2, rate_hz: 5, noise: false}
  camera: {model: wide640, yaw_deg: 90, width: 320, height: 240, rate_hz: 20}
  imu: {model: bmi055, rate_hz: 100}
estimator:
  name: imu
  vision: {enabled: false, feature_share: 0.5}
  lidar: {resolution_factor: 2}
  degeneracy: {remapping: false}
expect: {status: ok, drift_percent: {max: 0.5}, progress_ratio: {min: 0.98, max: 1.02}}
)");
  EXPECT_EQ(scenario.seed, 7U);
  EXPECT_EQ(scenario.world.scene, "corridor");
  EXPECT_EQ(scenario.world.seed, 9U);
  EXPECT_EQ(scenario.world.light_lux, 50.0);
  ASSERT_EQ(scenario.world.light_schedule.size(), 2U);
  EXPECT_EQ(scenario.world.light_schedule[0].factor, 0.5);
  EXPECT_EQ(scenario.motion.attitude, MotionConfig::Attitude::kThrust);
  EXPECT_EQ(scenario.motion.gait_pitch_deg, 4.0);
  ASSERT_EQ(scenario.motion.oscillations.size(), 1U);
  EXPECT_EQ(scenario.motion.oscillations[0].axis, Oscillation::Axis::kPitch);
  ASSERT_EQ(scenario.motion.waypoints.size(), 3U);
  EXPECT_EQ(scenario.motion.waypoints[1].speed_mps, 4.0);
  EXPECT_EQ(scenario.rig.decimation, 2);
  EXPECT_FALSE(scenario.rig.lidar_effects.range_noise);
  EXPECT_TRUE(scenario.rig.camera.effects.shot_noise);
  EXPECT_EQ(scenario.rig.lidar.rate_hz, 5.0);
  EXPECT_EQ(scenario.rig.camera.model.width, 320);
  EXPECT_EQ(scenario.rig.imu.rate_hz, 100.0);
  EXPECT_EQ(scenario.estimator_name, "imu");
  EXPECT_FALSE(scenario.estimator.vision_enabled);
  EXPECT_TRUE(scenario.estimator.lidar_enabled);
  EXPECT_FALSE(scenario.estimator.remapping);
  EXPECT_EQ(scenario.estimator.feature_share, 0.5);
  EXPECT_EQ(scenario.estimator.resolution_factor, 2.0);
  ASSERT_EQ(scenario.expect.size(), 2U);
  EXPECT_EQ(scenario.expect_status, "ok");
}

TEST_F(ScenarioFile, PositivePitchLooksDownAndTheCameraLooksForward) {
  const Scenario scenario = load(kMotion + "rig: {pitch_deg: 90, camera: {yaw_deg: 90}}\n");
  const Eigen::Vector3d down = scenario.rig.vehicle_from_pack.rotation * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(down.isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
  const Eigen::Vector3d left = scenario.rig.camera.pack_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(left.isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST_F(ScenarioFile, OverridesWinOverTheFileAndTheLastOneOverAll) {
  const Scenario scenario = load(kMotion + "seed: 3\nrig: {z_m: 0.1}\n",
                                 {"rig.z_m=0.2", "rig.z_m=0.3", "rig.lidar.pitch_deg=+10",
                                  "world.light.schedule=[{start_s: 1, factor: 0}]", "estimator.name=imu"},
                                 5);
  EXPECT_EQ(scenario.seed, 5U);
  EXPECT_EQ(scenario.rig.vehicle_from_pack.translation.z(), 0.3);
  EXPECT_EQ(scenario.world.light_schedule.size(), 1U);
  EXPECT_EQ(scenario.estimator_name, "imu");
}

TEST_F(ScenarioFile, BaseIsReadFirstAndRelativeToItsFile) {
  std::filesystem::create_directories(files_.path() / "deep");
  files_.write("deep/root.yaml", kMotion + "seed: 2\nrig: {x_m: 0.1, z_m: 0.1}\n");
  files_.write("deep/middle.yaml", "base: root.yaml\nrig: {z_m: 0.2}\n");
  const Scenario scenario = load("base: deep/middle.yaml\nworld: {scene: tunnel}\n");
  EXPECT_EQ(scenario.seed, 2U);
  EXPECT_TRUE(scenario.rig.vehicle_from_pack.translation.isApprox(Eigen::Vector3d(0.1, 0, 0.2)));
  EXPECT_EQ(scenario.world.scene, "tunnel");
}

TEST_F(ScenarioFile, DigestDependsOnTheKeysAlone) {
  const std::string digest = load("seed: 1\n" + kMotion).digest;
  EXPECT_EQ(digest.size(), 16U);
  EXPECT_EQ(digest, load("# a remark\n" + kMotion).digest);
  EXPECT_EQ(digest, load(kMotion + "seed: 4\n", {}, 1).digest);
  EXPECT_NE(digest, load(kMotion, {}, 2).digest);
  EXPECT_NE(digest, load(kMotion, {"rig.z_m=0.1"}).digest);
}

TEST_F(ScenarioFile, ResolvedYamlReadsBackAsTheSameScenario) {
  const Scenario scenario = load(kMotion, {"rig.lidar.model='vlp16'", "world.light.schedule=[]", "motion.speed_mps=2"});
  const Scenario again = load(scenario.resolved_yaml);
  EXPECT_EQ(again.resolved_yaml, scenario.resolved_yaml);
  EXPECT_EQ(again.motion.speed_mps, 2.0);
}

struct BadInput {
  std::string what;
  std::string text;
  std::vector<std::string> overrides;
  std::vector<std::string> message;  ///< parts that it must hold

  friend void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.what; }
};

class BadScenario : public ScenarioFile, public testing::WithParamInterface<BadInput> {};

TEST_P(BadScenario, IsRefusedWithAMessageThatHelps) {
  const std::string message = complaint(GetParam().text, GetParam().overrides);
  for (const auto& part : GetParam().message) EXPECT_THAT(message, HasSubstr(part));
}

std::string name_of(const testing::TestParamInfo<BadInput>& bad) { return bad.param.what; }

std::string nested(int levels) {
  return "x: " + std::string(static_cast<std::size_t>(levels), '[') +
         std::string(static_cast<std::size_t>(levels), ']');
}

std::string alias_bomb() {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string name = std::string("a").append(std::to_string(i));
    const std::string one = std::string("*a").append(std::to_string(i - 1));
    text += name + ": &" + name + " [" + one;
    for (int k = 0; k < 8; ++k) text += ", " + one;
    text += "]\n";
  }
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadScenario,
    testing::Values(BadInput{"Empty", "", {}, {"file.yaml", "found nothing", "a map of keys"}},
                    BadInput{"NoMap", "just words", {}, {"file.yaml:1", "'just words'", "a map of keys"}},
                    BadInput{"NoMotion", "seed: 1\n", {}, {"file.yaml", "motion"}},
                    BadInput{"Syntax", "seed: [1, 2\nworld: }\n", {}, {"file.yaml:", "not valid YAML"}},
                    BadInput{"TwoDocuments", kMotion + "---\nseed: 1\n", {}, {"second document"}},
                    BadInput{"DoubleKey", kMotion + "seed: 1\nseed: 2\n", {}, {"file.yaml:3", "'seed'", "twice"}},
                    BadInput{"Tag", kMotion + "seed: !!python/object 1\n", {}, {"file.yaml:2", "tag"}},
                    BadInput{"ListAsKey", kMotion + "[1, 2]: 3\n", {}, {"plain word"}},
                    BadInput{"TooLarge", kMotion + "# " + std::string(1'100'000, 'x'), {}, {"1 MB"}},
                    BadInput{"TooDeep", nested(400), {}, {"file.yaml:1", "nested deeper than 32"}},
                    BadInput{"FarTooDeep", nested(100'000), {}, {"file.yaml:1", "nested deeper than 32"}},
                    BadInput{"AliasBomb", alias_bomb(), {}, {"more than 20000 values"}},
                    BadInput{"AliasOfItself", "x: &x [*x]\n", {}, {"file.yaml:1", "nested deeper than 32"}},
                    BadInput{"MissingBase", "base: nowhere.yaml\n", {}, {"file.yaml:1", "base", "nowhere.yaml"}},
                    BadInput{"BaseOfItself", "base: file.yaml\n", {}, {"file.yaml:1", "lead back"}},
                    BadInput{"MissingMjcf", kMotion + "world: {mjcf: none.xml}\n", {}, {"world.mjcf", "none.xml"}},
                    BadInput{"MissingTum", "motion: {tum: none.tum}\n", {}, {"motion.tum", "none.tum"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Keys, BadScenario,
    testing::Values(
        BadInput{"Unknown", kMotion + "wrold: {}\n", {}, {"file.yaml:2", "wrold: unknown key", "'world'"}},
        BadInput{"UnknownBelow", "motion:\n  speed: 2\n", {}, {"file.yaml:2", "motion.speed", "motion.speed_mps"}},
        BadInput{"WrongUnit", kMotion + "rig: {z_cm: 5}\n", {}, {"rig.z_cm: unknown key", "'rig.z_m'"}},
        BadInput{"Word", "motion: {speed_mps: fast}\n", {}, {"motion.speed_mps", "'fast'", "a number from 0.05 to 60"}},
        BadInput{"Unit", "motion: {speed_mps: 2 m/s}\n", {}, {"motion.speed_mps", "'2 m/s'"}},
        BadInput{"String", "motion: {speed_mps: '2'}\n", {}, {"the string '2'", "a number"}},
        BadInput{"NotANumber", "motion: {speed_mps: .nan}\n", {}, {"'.nan'", "a number"}},
        BadInput{"PlainNan", "motion: {speed_mps: nan}\n", {}, {"'nan'", "a number"}},
        BadInput{"Infinity", "motion: {speed_mps: inf}\n", {}, {"'inf'", "a number"}},
        BadInput{"OutOfRange", "motion: {speed_mps: -1}\n", {}, {"'-1'", "from 0.05 to 60"}},
        BadInput{"Huge", "motion: {speed_mps: 1e999}\n", {}, {"'1e999'"}},
        BadInput{"Nothing", "motion: {speed_mps: }\n", {}, {"motion.speed_mps", "found nothing"}},
        BadInput{"MapForNumber", "motion: {speed_mps: {a: 1}}\n", {}, {"a map of keys", "a number"}},
        BadInput{"NumberForMap", "motion: 3\n", {}, {"motion: found '3'", "a map of keys"}},
        BadInput{"NegativeSeed", kMotion + "seed: -1\n", {}, {"seed", "'-1'", "a whole number"}},
        BadInput{"FractionalSeed", kMotion + "seed: 1.5\n", {}, {"seed", "'1.5'"}},
        BadInput{
            "FractionalDecimation", kMotion + "rig: {decimation: 1.5}\n", {}, {"rig.decimation", "a whole number"}},
        BadInput{"Boolean", kMotion + "estimator: {vision: {enabled: yes}}\n", {}, {"'yes'", "true or false"}},
        BadInput{"OneWayPoint", "motion: {waypoints: [[0, 0, 1]]}\n", {}, {"motion.waypoints", "two way-points"}},
        BadInput{
            "FlatWayPoint", "motion: {waypoints: [[0, 0], [1, 1, 1]]}\n", {}, {"motion.waypoints[0]", "[x, y, z]"}},
        BadInput{"Attitude", "motion: {attitude: wild}\n", {}, {"'wild'", "heading, thrust"}},
        BadInput{"Scene", kMotion + "world: {scene: moon}\n", {}, {"world.scene", "'moon'", "garage"}},
        BadInput{"Parameter", kMotion + "world: {parameters: {moons: 3}}\n", {}, {"world.parameters.moons: unknown"}},
        BadInput{"Schedule",
                 kMotion + "world: {light: {schedule: [{start_s: 2, factor: 1}, {start_s: 1, factor: 1}]}}\n",
                 {},
                 {"world.light.schedule", "later than the one before"}},
        BadInput{"LidarModel", kMotion + "rig: {lidar: {model: hdl}}\n", {}, {"rig.lidar.model", "'hdl'", "vlp16"}},
        BadInput{"WrongKindOfModel", kMotion + "rig: {lidar: {model: bmi055}}\n", {}, {"'bmi055'", "vlp16"}},
        BadInput{"PathAsModel", kMotion + "rig: {imu: {model: ../../x}}\n", {}, {"rig.imu.model", "bmi055"}},
        BadInput{"Estimator", kMotion + "estimator: {name: magic}\n", {}, {"estimator.name", "'magic'", "vloam"}},
        BadInput{"Figure", kMotion + "expect: {drift: {max: 1}}\n", {}, {"expect.drift: unknown", "drift_percent"}},
        BadInput{
            "NoBound", kMotion + "expect: {drift_percent: {}}\n", {}, {"expect.drift_percent", "min, max or both"}},
        BadInput{"Bounds", kMotion + "expect: {drift_percent: {min: 2, max: 1}}\n", {}, {"min above max"}},
        BadInput{"Status", kMotion + "expect: {status: good}\n", {}, {"expect.status", "'good'", "ok"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Overrides, BadScenario,
    testing::Values(
        BadInput{"NoEquals", kMotion, {"seed"}, {"--set seed", "KEY=VALUE"}},
        BadInput{"NoKey", kMotion, {"=1"}, {"--set =1", "words joined by dots"}},
        BadInput{"GapInKey", kMotion, {"rig..z_m=1"}, {"--set rig..z_m=1", "words joined by dots"}},
        BadInput{"OddKey", kMotion, {"rig z=1"}, {"'rig z'"}},
        BadInput{"NoValue", kMotion, {"rig.z_m="}, {"--set rig.z_m=", "found nothing"}},
        BadInput{"BadYaml", kMotion, {"rig.z_m=[1"}, {"--set rig.z_m=[1", "not valid YAML"}},
        BadInput{"BadValue", kMotion, {"rig.z_m=tall"}, {"--set rig.z_m=tall", "rig.z_m", "'tall'", "from -10 to 10"}},
        BadInput{"UnknownKey", kMotion, {"rig.height=1"}, {"--set rig.height=1", "unknown key"}},
        BadInput{"Base", kMotion, {"base=x.yaml"}, {"--set base=x.yaml", "only be set in a file"}},
        BadInput{"ScalarForMap", kMotion, {"rig=1"}, {"--set rig=1", "a map of keys"}},
        BadInput{"SectionBelowScalar", kMotion + "seed: 1\n", {"seed.x=1"}, {"--set seed.x=1", "a whole number"}}),
    name_of);

TEST_F(ScenarioFile, LongChainsAndLoopsOfBasesAreRefused) {
  files_.write("a.yaml", "base: b.yaml\n");
  files_.write("b.yaml", "base: a.yaml\n");
  EXPECT_THAT(complaint("base: a.yaml\n"), AllOf(HasSubstr("b.yaml:1"), HasSubstr("lead back")));
  files_.write("base0.yaml", kMotion);
  for (int i = 1; i <= 10; ++i) {
    const std::string below = std::to_string(i - 1);
    files_.write("base" + std::to_string(i) + ".yaml", "base: base" + below + ".yaml\n");
  }
  EXPECT_THAT(complaint("base: base10.yaml\n"), HasSubstr("at most 8 bases"));
  EXPECT_EQ(complaint("base: base7.yaml\n"), "");
}

TEST_F(ScenarioFile, ThatIsMissingOrADirectoryIsNamed) {
  EXPECT_THAT([&] { load_scenario(files_.path() / "none.yaml", {}, {}); },
              testing::ThrowsMessage<InputError>(AllOf(HasSubstr("none.yaml"), HasSubstr("no such file"))));
  EXPECT_THAT([&] { load_scenario(files_.path(), {}, {}); },
              testing::ThrowsMessage<InputError>(HasSubstr("not a regular file")));
}

}  // namespace
}  // namespace plumbline
