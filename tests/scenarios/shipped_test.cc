#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "scenarios/catalogue.h"
#include "scenarios/scenario.h"
#include "scenarios/session.h"
#include "scenarios/yaml_reader.h"
#include "tests/scenarios/body_trajectory.h"

namespace plumbline {
namespace {

std::vector<std::filesystem::path> shipped_scenarios() {
  std::vector<std::filesystem::path> paths;
  for (const char* folder : {PLUMBLINE_SCENARIO_DIR, PLUMBLINE_SCENARIO_DIR "/suites/parts"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".yaml") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct Peaks {
  double distance_m = 0.0;
  double speed_mps = 0.0;
  double rate_deg_per_s = 0.0;
  double acceleration_mps2 = 0.0;
  double duration_s = 0.0;
};

Peaks peaks_of(const std::string& name) {
  const auto path = std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / (name + ".yaml");
  const Trajectory trajectory = body_trajectory(load_scenario(path, {}, {}));
  Peaks peaks;
  peaks.duration_s = 1e-9 * static_cast<double>(trajectory.end_ns());
  constexpr std::int64_t kStep_ns = 5'000'000;
  for (std::int64_t stamp_ns = kStep_ns; stamp_ns <= trajectory.end_ns(); stamp_ns += kStep_ns) {
    const MotionState state = trajectory.at(stamp_ns);
    const Eigen::Vector3d before = trajectory.pose(stamp_ns - kStep_ns).translation;
    peaks.distance_m += (state.world_from_body.translation - before).norm();
    peaks.speed_mps = std::max(peaks.speed_mps, state.velocity_in_world.norm());
    peaks.rate_deg_per_s = std::max(peaks.rate_deg_per_s, state.angular_rate_in_body.norm() * 180.0 / M_PI);
    peaks.acceleration_mps2 = std::max(peaks.acceleration_mps2, state.acceleration_in_world.norm());
  }
  return peaks;
}

TEST(ShippedScenarios, LoadAndSayWhatTheyExpect) {
  EXPECT_GE(shipped_scenarios().size(), 5U);
  for (const auto& path : shipped_scenarios()) {
    SCOPED_TRACE(path.filename());
    const Scenario scenario = load_scenario(path, {}, {});
    // The parts of suites are judged against a baseline.
    if (path.parent_path().filename() == "parts") continue;
    EXPECT_FALSE(scenario.expect.empty());
    EXPECT_EQ(scenario.expect_status, "ok");
  }
}

TEST(ShippedScenarios, RunOnOneSetOfEstimatorSettings) {
  for (const auto& path : shipped_scenarios()) {
    SCOPED_TRACE(path.filename());
    const ConfigNode file = read_yaml_file(path);
    const auto estimator = file.entries.find("estimator");
    if (estimator == file.entries.end()) continue;
    for (const auto& [key, value] : estimator->second.entries) {
      if (key == "name") continue;
      ASSERT_TRUE(value.is_map()) << key;
      for (const auto& [below, setting] : value.entries) {
        EXPECT_TRUE(below == "enabled" || (key == "degeneracy" && below == "remapping")) << key << '.' << below;
      }
    }
  }
}

TEST(ShippedScenarios, AreWhatTheirNamesPromise) {
  const Peaks quickstart = peaks_of("quickstart");
  EXPECT_GE(quickstart.distance_m, 100.0);
  EXPECT_GE(quickstart.duration_s, 60.0);
  EXPECT_LE(quickstart.duration_s, 90.0);
  for (const auto* name : {"corridor", "dark_corridor", "tunnel_short", "aggressive_flight"}) {
    EXPECT_GE(peaks_of(name).distance_m, 60.0) << name;
  }
  const Peaks flight = peaks_of("aggressive_flight");
  EXPECT_GE(flight.speed_mps, 5.0);
  EXPECT_GE(flight.rate_deg_per_s, 200.0);
  EXPECT_GE(flight.acceleration_mps2, 9.81);
}

TEST(ShippedScenarios, DarkCorridorIsDarkForTheMiddleThird) {
  const auto path = std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "dark_corridor.yaml";
  const auto schedule = load_scenario(path, {}, {}).world.light_schedule;
  const double duration_s = peaks_of("dark_corridor").duration_s;
  ASSERT_EQ(schedule.size(), 2U);
  EXPECT_EQ(schedule[0].factor, 0.0);
  EXPECT_EQ(schedule[1].factor, 1.0);
  EXPECT_NEAR(schedule[0].start_s, duration_s / 3.0, 2.0);
  EXPECT_NEAR(schedule[1].start_s, duration_s * 2.0 / 3.0, 2.0);
}

TEST(Catalogue, DevicesLoadAndAreValid) {
  for (const auto& name : catalogue_names("lidar")) EXPECT_NO_THROW(validate_or_throw(catalogue_lidar(name))) << name;
  for (const auto& name : catalogue_names("camera")) EXPECT_NO_THROW(validate_or_throw(catalogue_camera(name))) << name;
  for (const auto& name : catalogue_names("imu")) EXPECT_NO_THROW(validate_or_throw(catalogue_imu(name))) << name;
  EXPECT_GE(sensor_catalogue().size(), 3U);
}

TEST(Catalogue, Vlp16IsTheOneOfTheSensorsOwnTests) {
  const LidarModel file = catalogue_lidar("vlp16");
  const LidarModel code = vlp16();
  ASSERT_EQ(file.beams.size(), code.beams.size());
  for (std::size_t i = 0; i < code.beams.size(); ++i) {
    EXPECT_EQ(file.beams[i].elevation_deg, code.beams[i].elevation_deg);
    EXPECT_EQ(file.beams[i].azimuth_deg, code.beams[i].azimuth_deg);
    EXPECT_NEAR(file.beams[i].vertical_offset_m, code.beams[i].vertical_offset_m, 1e-12);
    EXPECT_NEAR(file.beams[i].firing_s, code.beams[i].firing_s, 1e-15);
  }
  EXPECT_NEAR(std::get<SpinningHead>(file.head).cycle_s, std::get<SpinningHead>(code.head).cycle_s, 1e-15);
  constexpr double LidarModel::*kFigures[] = {
      &LidarModel::rate_hz,           &LidarModel::encoder_resolution_deg,    &LidarModel::min_range_m,
      &LidarModel::max_range_m,       &LidarModel::range_at_10_percent_m,     &LidarModel::range_sigma_m,
      &LidarModel::pulse_s,           &LidarModel::range_sigma_at_limit_m,    &LidarModel::range_resolution_m,
      &LidarModel::ring_bias_sigma_m, &LidarModel::accuracy_sigma_m,          &LidarModel::exit_width_m,
      &LidarModel::exit_height_m,     &LidarModel::divergence_horizontal_rad, &LidarModel::divergence_vertical_rad};
  for (const auto figure : kFigures) EXPECT_DOUBLE_EQ(file.*figure, code.*figure);
}

}  // namespace
}  // namespace plumbline
