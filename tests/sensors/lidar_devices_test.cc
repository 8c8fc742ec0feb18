// Each lidar of the catalogue against its data sheet, and what must hold of all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/catalogue.h"
#include "sensors/lidar.h"
#include "sim/constants.h"
#include "tools/verify/lidar_firing_check.h"
#include "tools/verify/lidar_stand.h"

namespace plumbline {
namespace {

TEST(LidarDevices, FireAtTheTimesAndAnglesOfTheirDataSheets) {
  std::vector<std::string> checked;
  for (const FiringCheck& check : check_lidar_firing()) {
    SCOPED_TRACE(check.device + " at " + std::to_string(check.rate_hz) + " Hz");
    EXPECT_LE(check.worst_time_ns, 1.0);
    EXPECT_LE(check.worst_angle_deg, 1e-4);
    EXPECT_EQ(check.misplaced, 0);
    EXPECT_EQ(check.points, check.expected_points);
    checked.push_back(check.device);
  }
  for (const std::string& name : catalogue_names("lidar")) {
    EXPECT_NE(std::find(checked.begin(), checked.end(), name), checked.end()) << name;
  }
}

TEST(LidarDevices, TheEncoderTurnsPointsInStepsAboutTheJointsAxis) {
  const LidarStand sphere(kSphere);
  LidarEffects quantised = LidarEffects::none();
  quantised.quantisation = true;
  const Lidar lidar(catalogue_lidar("utm30lx_sweeping"), Pose{}, 1, quantised);
  for (const LidarPoint& point : sphere.scan(lidar, 2).points) {
    const double off_axis = std::hypot(point.position.y(), point.position.z());
    if (off_axis < 0.5) continue;
    // The joint's plane as reported: a multiple of 0.25 degrees.
    const double joint_deg = std::atan2(point.position.z(), point.position.y()) / kDegree;
    ASSERT_NEAR(std::remainder(joint_deg, 0.25), 0.0, 1e-4);
  }
}

TEST(LidarDevices, TwoRunsGiveTheSameBytes) {
  const LidarStand sphere(kSphere);
  for (const std::string& name : catalogue_names("lidar")) {
    const LidarModel model = catalogue_lidar(name);
    const LidarScan one = sphere.scan(Lidar(model, Pose{}, 3), 4);
    const Lidar other(model, Pose{}, 3);
    sphere.scan(other, 1);
    const LidarScan two = sphere.scan(other, 4);
    ASSERT_FALSE(one.points.empty()) << name;
    EXPECT_TRUE(std::equal(one.points.begin(), one.points.end(), two.points.begin(), two.points.end(),
                           [](const LidarPoint& a, const LidarPoint& b) {
                             return a.position == b.position && a.offset_ns == b.offset_ns && a.ring == b.ring &&
                                    a.intensity == b.intensity;
                           }))
        << name;
  }
}

}  // namespace
}  // namespace plumbline
