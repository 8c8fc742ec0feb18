// Clocks, transport, miscalibration and faults as scenarios give them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/calibration.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using testing::HasSubstr;

constexpr char kScenario[] = R"(
world: {scene: garage}
motion: {waypoints: [[6, 4.75, 1.5], [10, 4.75, 1.5]]}
)";

Scenario with(const std::vector<std::string>& overrides, std::uint64_t seed = 1) {
  const TemporaryDirectory files;
  return load_scenario(files.write("errors.yaml", kScenario), overrides, seed);
}

struct BadKey {
  std::string what;
  std::string override_text;
  std::vector<std::string> message;  ///< parts that it must hold

  friend void PrintTo(const BadKey& bad, std::ostream* out) { *out << bad.what; }
};

class BadSensorErrors : public testing::TestWithParam<BadKey> {};

TEST_P(BadSensorErrors, AreRefusedWithAMessageThatHelps) {
  for (const std::string& part : GetParam().message) {
    EXPECT_THAT([&] { with({GetParam().override_text}); }, testing::ThrowsMessage<InputError>(HasSubstr(part)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Timing, BadSensorErrors,
    testing::Values(BadKey{"Clock", "rig.imu.clock=late", {"rig.imu.clock", "'late'", "a map of keys"}},
                    BadKey{"ClockKey", "rig.lidar.clock.offset_s=1", {"rig.lidar.clock.offset_s", "unknown key"}},
                    BadKey{"Offset", "rig.camera.clock.offset_ms=1e6", {"rig.camera.clock.offset_ms", "-10000"}},
                    BadKey{"Drift", "rig.imu.clock.drift_ppm=20000", {"rig.imu.clock.drift_ppm", "10000"}},
                    BadKey{"Jitter", "rig.lidar.clock.jitter_us=-1", {"rig.lidar.clock.jitter_us", "'-1'"}},
                    BadKey{"Delay", "rig.camera.delay_ms=-3", {"rig.camera.delay_ms", "'-3'"}},
                    BadKey{"DelayJitter", "rig.imu.delay_jitter_ms=x", {"rig.imu.delay_jitter_ms", "'x'"}}),
    [](const auto& bad) { return bad.param.what; });

INSTANTIATE_TEST_SUITE_P(
    Miscalibration, BadSensorErrors,
    testing::Values(
        BadKey{"Angle", "rig.lidar.miscalibration.yaw_deg=200", {"rig.lidar.miscalibration.yaw_deg", "180"}},
        BadKey{"Place", "rig.camera.miscalibration.z_m=11", {"rig.camera.miscalibration.z_m", "from -10 to 10"}},
        BadKey{"Sigma", "rig.camera.miscalibration.sigma_m=-0.1", {"rig.camera.miscalibration.sigma_m", "'-0.1'"}},
        BadKey{"NotOfTheImu", "rig.imu.miscalibration.yaw_deg=1", {"rig.imu.miscalibration", "unknown key"}}),
    [](const auto& bad) { return bad.param.what; });

INSTANTIATE_TEST_SUITE_P(
    Faults, BadSensorErrors,
    testing::Values(
        BadKey{"NoList", "faults=7", {"faults", "'7'"}},
        BadKey{"Sensor", "faults=[{sensor: nose, kind: nan, start_s: 1, end_s: 2}]", {"faults[0].sensor", "'nose'"}},
        BadKey{"Kind", "faults=[{sensor: imu, kind: tired, start_s: 1, end_s: 2}]", {"faults[0].kind", "'tired'"}},
        BadKey{"NotOfThisSensor",
               "faults=[{sensor: imu, kind: black, start_s: 1, end_s: 2}]",
               {"faults[0].kind", "that this sensor can have"}},
        BadKey{"NoEnd", "faults=[{sensor: imu, kind: nan, start_s: 1}]", {"faults[0]", "end_s in every entry"}},
        BadKey{
            "EndBeforeStart",
            "faults=[{sensor: imu, kind: nan, start_s: 1, end_s: 2}, {sensor: imu, kind: nan, start_s: 2, end_s: 2}]",
            {"faults[1]", "an end_s after start_s"}},
        BadKey{"Probability",
               "faults=[{sensor: lidar, kind: nan, start_s: 1, end_s: 2, probability: 1.5}]",
               {"faults[0].probability", "from 0 to 1"}},
        BadKey{"UnknownKey",
               "faults=[{sensor: lidar, kind: nan, start_s: 1, end_s: 2, odds: 1}]",
               {"faults[0].odds", "unknown key"}}),
    [](const auto& bad) { return bad.param.what; });

void expect_same(const Pose& a, const Pose& b) {
  // Told and true mounting are products of each other.
  EXPECT_LT((a.translation - b.translation).norm(), 1e-12);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
}

TEST(Miscalibration, MovesTheSensorsAndNotWhatTheEstimatorIsTold) {
  const RigConfig as_told = with({"rig.stereo.baseline_m=0.12"}).rig;
  const RigConfig moved = with({"rig.stereo.baseline_m=0.12",
                                "rig.lidar.miscalibration={yaw_deg: 3, x_m: 0.05, sigma_deg: 1, sigma_m: 0.01}",
                                "rig.camera.miscalibration={roll_deg: -2, z_m: 0.04}"})
                              .rig;
  const Calibration told = calibration_of(as_told);
  const Calibration still_told = calibration_of(moved);
  expect_same(still_told.body_from_lidar, told.body_from_lidar);
  expect_same(still_told.body_from_camera, told.body_from_camera);
  ASSERT_EQ(still_told.further_cameras.size(), told.further_cameras.size());

  const Pose camera_error = as_told.camera.pack_from_camera.inverse() * moved.camera.pack_from_camera;
  EXPECT_NEAR(camera_error.translation.norm(), 0.04, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(camera_error.rotation).angle(), 2.0 * M_PI / 180.0, 1e-9);
  const Pose lidar_error = as_told.pack_from_lidar.inverse() * moved.pack_from_lidar;
  EXPECT_NEAR(lidar_error.translation.x(), 0.05, 0.05);  // five of the drawn part's standard deviations
  EXPECT_NEAR(Eigen::AngleAxisd(lidar_error.rotation).angle(), 3.0 * M_PI / 180.0, 5.0 * M_PI / 180.0);
}

TEST(Miscalibration, IsDrawnPerSeed) {
  const std::vector<std::string> drawn{"rig.lidar.miscalibration={sigma_deg: 1, sigma_m: 0.01}"};
  const Pose one = with(drawn, 1).rig.pack_from_lidar;
  expect_same(one, with(drawn, 1).rig.pack_from_lidar);
  EXPECT_GT((one.translation - with(drawn, 2).rig.pack_from_lidar.translation).norm(), 1e-4);
}

}  // namespace
}  // namespace plumbline
