#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/constants.h"
#include "tests/scenarios/body_trajectory.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

constexpr double kStep_s = 0.005;

Trajectory motion_of(const std::string& name) {
  return body_trajectory(load_scenario(std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / (name + ".yaml"), {}, {}));
}

double duration_s(const Trajectory& motion) { return 1e-9 * static_cast<double>(motion.end_ns()); }

TEST(MotionScenarios, SPathTurns330DegreesIn8Seconds) {
  const Trajectory motion = motion_of("s_path");
  std::vector<double> turned{0.0};  // to either side, since the start
  for (double t = kStep_s; t < duration_s(motion); t += kStep_s) {
    turned.push_back(turned.back() + kStep_s * std::abs(motion.at_seconds(t).angular_rate_in_body.z()));
  }
  const auto window = static_cast<std::size_t>(8.0 / kStep_s);
  double most = 0.0;
  for (std::size_t i = window; i < turned.size(); ++i) most = std::max(most, turned[i] - turned[i - window]);
  EXPECT_GE(most / kDegree, 330.0);
}

TEST(MotionScenarios, HandsSpinAndShakeAsFastAsTheirFilesSay) {
  for (const auto& [name, peak_dps] : {std::pair{"spinning", 370.0}, std::pair{"shaking", 250.0}}) {
    const Trajectory motion = motion_of(name);
    double peak = 0.0;
    for (double t = 0.0; t < duration_s(motion); t += kStep_s) {
      peak = std::max(peak, motion.at_seconds(t).angular_rate_in_body.norm());
    }
    // Gait and unsteady hands add a few degrees per second to the spin's own peak.
    EXPECT_NEAR(peak / kDegree, peak_dps, 0.1 * peak_dps) << name;
  }
  EXPECT_NEAR(duration_s(motion_of("spinning")), 82.0, 1.5);
}

TEST(MotionScenarios, TunnelBendGoesAllTheWayRoundItsBend) {
  const Trajectory motion = motion_of("tunnel_bend");
  const Pose begin = motion.pose(0);
  const Pose end = motion.pose(motion.end_ns());
  const Eigen::Vector3d ahead = begin.rotation.inverse() * end.rotation * Eigen::Vector3d::UnitX();
  // The cart's driver still evens out its heading by a degree or so, 60 m after the bend.
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()) / kDegree, 45.0, 2.0);
  double length_m = 0.0;
  double top_mps = 0.0;
  for (double t = kStep_s; t < duration_s(motion); t += kStep_s) {
    const double speed_mps = motion.at_seconds(t).velocity_in_world.norm();
    length_m += kStep_s * speed_mps;
    top_mps = std::max(top_mps, speed_mps);
  }
  EXPECT_NEAR(length_m, 350.0, 5.0);  // all but 15 m at both ends
  EXPECT_NEAR(top_mps, 3.0, 0.5);
}

class MotionKeys : public ::testing::Test {
 protected:
  /// The quickstart with other settings.
  static Trajectory with(const std::vector<std::string>& overrides) {
    return body_trajectory(
        load_scenario(std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "quickstart.yaml", overrides, {}));
  }
  static void expect_error(const std::vector<std::string>& overrides, const std::string& part) {
    EXPECT_THAT([&] { with(overrides); }, ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(part)));
  }
};

TEST_F(MotionKeys, AreNamedWhenTheyAreWrong) {
  expect_error({"motion.vehicle=sledge"}, "motion.vehicle");
  expect_error({"motion.route=nowhere"}, "motion.route");
  expect_error({"motion.roughness_m=-1"}, "motion.roughness_m");
  expect_error({"motion.spin.mean=3"}, "motion.spin.mean");
  expect_error({"motion.vehicle=car"}, "the car cannot turn as tightly");
}

TEST_F(MotionKeys, VehiclesBringTheirOwnDefaults) {
  const auto path = std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "s_path.yaml";
  const Scenario scenario = load_scenario(path, {}, {});
  EXPECT_EQ(scenario.motion.vehicle, "car");
  EXPECT_EQ(scenario.motion.roughness_m, 0.003);      // the car's
  EXPECT_EQ(scenario.motion.acceleration_mps2, 2.5);  // the file's
}

}  // namespace
}  // namespace plumbline
