// The real estimator under each fault: it must go on.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "scenarios/session.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

constexpr char kFaultyScenario[] = R"(
world: {scene: corridor}
motion: {rest_s: 1, smoothing_s: 1, speed_mps: 1.5, waypoints: [[1.5, 0, 1.5], [3.5, 0, 1.5]]}
rig: {camera: {width: 160, height: 96, rate_hz: 20}}
)";

using SensorAndKind = std::pair<std::string, std::string>;

/// A world is dear to build, and faults leave it as it is.
struct Corridor {
  World world;
  RayScene rays{world};
};

class FaultySession : public testing::TestWithParam<SensorAndKind> {};

TEST_P(FaultySession, GoesOnWithFiniteOutputsAndCountsEveryMessage) {
  const TemporaryDirectory files;
  const auto& [sensor, kind] = GetParam();
  const std::string fault =
      "faults=[{sensor: " + sensor + ", kind: " + kind + ", start_s: 1.5, end_s: 2.5, probability: 0.6}]";
  const Scenario scenario = load_scenario(files.write("faulty.yaml", kFaultyScenario), {fault}, {});
  static const Corridor corridor{make_world(scenario)};
  const RunRecord record = run_session(scenario, corridor.world, corridor.rays, {});
  EXPECT_EQ(record.fault, "");
  ASSERT_FALSE(record.estimate.empty());
  for (const auto& [stamp_ns, pose] : record.estimate) {
    ASSERT_TRUE(pose.translation.allFinite() && pose.rotation.coeffs().allFinite()) << stamp_ns;
  }
  for (const auto& [module, tally] : record.messages) {
    std::int64_t accounted = tally.used;
    for (const auto& [reason, count] : tally.dropped) accounted += count;
    // What waits for an IMU sample at the end is neither.
    EXPECT_NEAR(static_cast<double>(accounted), static_cast<double>(tally.produced), 2.0);
  }
}

INSTANTIATE_TEST_SUITE_P(EachFault, FaultySession,
                         testing::Values(SensorAndKind{"imu", "drop_out"}, SensorAndKind{"imu", "freeze"},
                                         SensorAndKind{"imu", "nan"}, SensorAndKind{"imu", "duplicate"},
                                         SensorAndKind{"imu", "reorder"}, SensorAndKind{"camera", "drop_out"},
                                         SensorAndKind{"camera", "freeze"}, SensorAndKind{"camera", "duplicate"},
                                         SensorAndKind{"camera", "reorder"}, SensorAndKind{"camera", "saturated"},
                                         SensorAndKind{"camera", "black"}, SensorAndKind{"lidar", "drop_out"},
                                         SensorAndKind{"lidar", "freeze"}, SensorAndKind{"lidar", "nan"},
                                         SensorAndKind{"lidar", "duplicate"}, SensorAndKind{"lidar", "reorder"},
                                         SensorAndKind{"lidar", "partial"}),
                         [](const auto& fault) { return fault.param.first + "_" + fault.param.second; });

}  // namespace
}  // namespace plumbline
