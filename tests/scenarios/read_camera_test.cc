#include "scenarios/read_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/calibration.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using testing::HasSubstr;

class CameraKeys : public testing::Test {
 protected:
  RigConfig load(const std::string& rig) {
    const std::string text = "motion: {waypoints: [[0, 0, 1], [10, 0, 1]]}\nrig: {" + rig + "}\n";
    return load_scenario(files_.write("file.yaml", text), {}, std::nullopt).rig;
  }

  std::string complaint(const std::string& rig) {
    try {
      load(rig);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryDirectory files_;
};

TEST_F(CameraKeys, EveryEffectHasItsSwitch) {
  const auto effects = [&](const std::string& keys) { return load("camera: {" + keys + "}").camera.effects; };
  EXPECT_TRUE(effects("").motion_blur);
  EXPECT_FALSE(effects("effects: {motion_blur: false}").motion_blur);
  EXPECT_FALSE(effects("effects: {vignetting: false}").vignetting);
  EXPECT_FALSE(effects("effects: {distortion: false}").distortion);
  EXPECT_FALSE(effects("effects: {rolling_shutter: false}").rolling_shutter);
  EXPECT_FALSE(effects("effects: {shot_noise: false}").shot_noise);
  EXPECT_TRUE(effects("effects: {shot_noise: false}").read_noise);
  EXPECT_FALSE(effects("effects: {read_noise: false}").read_noise);
  EXPECT_FALSE(effects("effects: {dark_current: false}").dark_current);
  const CameraEffects silent = effects("noise: false");
  EXPECT_FALSE(silent.shot_noise || silent.dark_current || silent.read_noise);
  EXPECT_TRUE(silent.motion_blur && silent.vignetting);
  EXPECT_THAT(complaint("camera: {effects: {motionblur: false}}"), HasSubstr("motion_blur"));
}

TEST_F(CameraKeys, LensAndShutterAreOptions) {
  const CameraModel model = load("camera: {distortion: [-0.1, 0.02, 0.001, 0], shutter: rolling}").camera.model;
  EXPECT_EQ(model.distortion.k1, -0.1);
  EXPECT_EQ(model.distortion.p1, 0.001);
  EXPECT_TRUE(model.rolling_shutter);
  EXPECT_THAT(complaint("camera: {distortion: [-0.1]}"), HasSubstr("[k1, k2, p1, p2]"));
  EXPECT_THAT(complaint("camera: {distortion: [-9, 0, 0, 0]}"), HasSubstr("invertible"));
  EXPECT_THAT(complaint("camera: {shutter: fast}"), HasSubstr("rolling"));
}

TEST_F(CameraKeys, FurtherCamerasAreThereWhenNamed) {
  const RigConfig plain = load("");
  EXPECT_FALSE(plain.stereo_baseline_m || plain.depth_camera || plain.colour_camera);
  EXPECT_TRUE(calibration_of(plain).further_cameras.empty());
  const RigConfig full = load(
      "camera: {model: kitti_grey}, stereo: {baseline_m: 0.54}, depth_camera: {model: xtion, z_m: 0.2}, "
      "colour_camera: {model: contour_colour, yaw_deg: 180}");
  EXPECT_EQ(full.stereo_baseline_m, 0.54);
  EXPECT_EQ(full.depth_camera->pack_from_camera.translation.z(), 0.2);
  EXPECT_TRUE(full.colour_camera->model.colour);
  const Eigen::Vector3d axis = full.colour_camera->pack_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(axis.isApprox(-Eigen::Vector3d::UnitX(), 1e-9));
  const Calibration calibration = calibration_of(full);
  ASSERT_EQ(calibration.further_cameras.size(), 2U);
  EXPECT_NEAR(calibration.camera.fx, 707.0, 1.0);
  EXPECT_EQ(calibration.further_cameras[0].intrinsics.width, 1226);
}

TEST_F(CameraKeys, GreyAndColourAreNotExchanged) {
  EXPECT_THAT(complaint("camera: {model: contour_colour}"), HasSubstr("a grey camera"));
  EXPECT_THAT(complaint("colour_camera: {model: wide640}"), HasSubstr("a colour camera"));
  EXPECT_THAT(complaint("camera: {model: xtion}"), HasSubstr("rig.camera.model"));
}

}  // namespace
}  // namespace plumbline
