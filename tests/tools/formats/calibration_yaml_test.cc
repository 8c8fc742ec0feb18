#include "tools/formats/calibration_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimator/geometry/so3.h"
#include "scenarios/calibration.h"
#include "scenarios/input_error.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Calibration full_calibration() {
  Calibration calibration;
  calibration.imu_rate_hz = 100.0 / 3.0;
  calibration.imu.gyro_bias_instability = 1e-300;
  calibration.body_from_camera = {exp_so3({0.1, -1.2, 0.3}), {0.1, 0.2, -1.0 / 3.0}};
  calibration.camera = {640, 480, 500.25, 501.0, 319.5, 239.5, {-0.3, 0.1, 1e-4, -2e-5}};
  calibration.body_from_lidar = {exp_so3({0.0, 0.5, 0.0}), {0.0, -0.0, 0.1}};
  calibration.further_cameras = {{1, calibration.body_from_camera.inverse(), calibration.camera, 25.0},
                                 {2, Pose{}, {320, 240, 300, 300, 160, 120, {}}, 30.0}};
  calibration.own_body = {{{exp_so3({0.0, 0.0, 0.7}), {-0.3, 0.0, 1.0 / 3.0}}, {0.1, 0.2, 0.3}}};
  return calibration;
}

std::string error_of(const std::string& text) {
  try {
    read_calibration_yaml(text, "mine.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string with(const std::string& what, const std::string& instead) {
  std::string text = calibration_yaml(full_calibration());
  const auto place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what << " is not in\n" << text;
  return text.replace(place, what.size(), instead);
}

TEST(CalibrationYaml, GivesEveryBitBack) {
  const std::string text = calibration_yaml(full_calibration());
  const Calibration found = read_calibration_yaml(text, "mine.yaml");
  // The shortest text that gives a number back is the same only for the same number.
  EXPECT_EQ(calibration_yaml(found), text);
  EXPECT_EQ(found.body_from_camera.rotation.coeffs(), full_calibration().body_from_camera.rotation.coeffs());
  EXPECT_EQ(found.imu_rate_hz, 100.0 / 3.0);
  EXPECT_EQ(found.camera.distortion.p2, -2e-5);
  ASSERT_EQ(found.further_cameras.size(), 2U);
  EXPECT_EQ(found.further_cameras[1].camera_id, 2);
  ASSERT_EQ(found.own_body.size(), 1U);
  EXPECT_EQ(found.own_body[0].half_size_m.z(), 0.3);
}

TEST(CalibrationYaml, SensorsThatAreNotThereAreLeftOut) {
  Calibration calibration;
  calibration.has_camera = false;
  calibration.has_lidar = false;
  const std::string text = calibration_yaml(calibration);
  EXPECT_THAT(text, Not(HasSubstr("camera")));
  const Calibration found = read_calibration_yaml(text, "mine.yaml");
  EXPECT_FALSE(found.has_camera || found.has_lidar);
}

TEST(CalibrationYaml, ReadsWhatAPersonWrites) {
  const std::string typed = R"(calibration_version: 1
imu: {rate_hz: 200, gyro_density_rad_per_s_sqrt_hz: 1e-4, accel_density_mps2_per_sqrt_hz: 1e-3,
  gyro_random_walk_rad_per_s2_sqrt_hz: 1e-5, accel_random_walk_mps3_per_sqrt_hz: 1e-4, gyro_turn_on_sigma_rad_per_s: 0,
  accel_turn_on_sigma_mps2: 0, gyro_bias_instability_rad_per_s: 0, accel_bias_instability_mps2: 0}
lidar:
  rate_hz: 10
  body_from_lidar: {translation_m: [0, 0, 0.1], quaternion_xyzw: [0, 0, 0.707107, 0.707107]}
  rings: 16
  range_sigma_m: 0.02
  min_range_m: 0.5
  max_range_m: 100
)";
  // Six digits leave a quaternion off unit length by 1e-7.
  EXPECT_NEAR(read_calibration_yaml(typed, "mine.yaml").body_from_lidar.rotation.norm(), 1.0, 1e-15);
}

TEST(CalibrationYaml, RefusesWithTheKey) {
  EXPECT_THAT(error_of("calibration_version: 2"), HasSubstr("mine.yaml: calibration_version: found 2"));
  EXPECT_THAT(error_of(""), HasSubstr("mine.yaml"));
  EXPECT_THAT(error_of("calibration_version: 1"), HasSubstr("imu: missing"));
  EXPECT_THAT(error_of(with("fx_px: 500.25\n", "\n")), HasSubstr("camera.fx_px: missing"));
  EXPECT_THAT(error_of(with("fx_px: 500.25", "fx_px: nan")), HasSubstr("camera.fx_px: found 'nan'"));
  EXPECT_THAT(error_of(with("rings:", "beams:")), HasSubstr("lidar.rings: missing"));
  EXPECT_THAT(error_of(with("rings: 16", "rings: 16\n  beams: 16")), HasSubstr("lidar.beams: unknown key"));
  EXPECT_THAT(error_of(with("distortion: [-0.3, ", "distortion: [")), HasSubstr("expected 4 numbers"));
  EXPECT_THAT(error_of(with("camera_id: 1", "camera_id: one")), HasSubstr("further_cameras.camera_id"));
  EXPECT_THAT(error_of(with("quaternion_xyzw: [0, 0, 0, 1]", "quaternion_xyzw: [0, 0, 0, 0.9]")),
              HasSubstr("unit length"));
}

}  // namespace
}  // namespace plumbline
