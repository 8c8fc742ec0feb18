// Moving cameras: what their frames show against what they must.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "scenarios/calibration.h"
#include "scenarios/catalogue.h"
#include "scenarios/frame_stream.h"
#include "sensors/image_motion.h"
#include "sim/ray_scene.h"
#include "tools/verify/moving_edge.h"

namespace plumbline {
namespace {

TEST(CameraOnRig, BlurIsSpeedTimesExposure) {
  for (const double speed_mps : {2.0, 4.0, 8.0}) {
    const BlurCheck check = check_blur(speed_mps, 6e-3);  // 2.8, 5.7 and 11.4 pixels
    EXPECT_NEAR(check.measured_px, check.expected_px, 0.2) << speed_mps;
  }
}

TEST(CameraOnRig, BlurCanBeSwitchedOff) {
  Scenario scenario = edge_scenario(exposed_for(6e-3));
  scenario.rig.camera.effects.motion_blur = false;
  EXPECT_LT(mean_blur_px(middle_frame(scenario, 4.0)), 0.5);
}

TEST(CameraOnRig, ARollingShutterLeansTheEdgeAsFarAsTheImageMovesMeanwhile) {
  CameraModel model = exposed_for(1e-3);
  model.rolling_shutter = true;
  model.exposure.row_time_s = 30e-6;
  const double px_per_s = intrinsics_of(model).fx * 3.0 / kEdgeDistance_m;
  const CameraFrame leaning = middle_frame(edge_scenario(model), 3.0);
  Scenario global = edge_scenario(model);
  global.rig.camera.effects.rolling_shutter = false;
  const CameraFrame upright = middle_frame(global, 3.0);
  for (const int row : {10, 100, 180, 260, 350}) {
    const double lag_s = (row - 179.5) * 30e-6;  // later rows see the camera farther left, the edge farther right
    const double lean_px = edge_in_row(leaning, row).column - edge_in_row(upright, row).column;
    EXPECT_NEAR(lean_px, px_per_s * lag_s, 0.6) << row;  // a picture a pixel
  }
}

double mean_of(const CameraFrame& frame) {
  return std::accumulate(frame.pixels.begin(), frame.pixels.end(), 0.0) / static_cast<double>(frame.pixels.size());
}

// In the dark one picture does, until there is light again: at once, if it comes on while the shutter is open.
TEST(CameraOnRig, LightThatComesOnDuringAnExposureIsInItsFrame) {
  Scenario scenario = edge_scenario(exposed_for(6e-3));
  scenario.rig.camera.effects.read_noise = true;
  const CameraFrame lit = middle_frame(scenario, 4.0);
  const double on_s = 1e-9 * static_cast<double>(lit.stamp_ns) + 1e-3;
  scenario.world.light_schedule = {{0.0, 1e-9}, {on_s, 1.0}};
  const CameraFrame partly_lit = middle_frame(scenario, 4.0);
  scenario.world.light_schedule = {{0.0, 1e-9}};
  const double dark = mean_of(middle_frame(scenario, 4.0));
  // A third of the exposure is lit, give or take half of one of its six pictures.
  EXPECT_NEAR((mean_of(partly_lit) - dark) / (mean_of(lit) - dark), 1.0 / 3.0, 0.1);
}

TEST(CameraOnRig, TheSameSeedGivesTheSameBytes) {
  Scenario scenario = edge_scenario(exposed_for(6e-3));
  scenario.rig.camera.model.width = 160;
  scenario.rig.camera.model.height = 90;
  scenario.rig.camera.effects = {};
  const std::vector<std::uint8_t> once = middle_frame(scenario, 4.0).pixels;
  EXPECT_EQ(once, middle_frame(scenario, 4.0).pixels);
  scenario.seed = 2;
  EXPECT_NE(once, middle_frame(scenario, 4.0).pixels);
}

TEST(CameraOnRig, TheSecondEyeSeesTheEdgeByItsBaseline) {
  Scenario scenario = edge_scenario(exposed_for(1e-3));
  scenario.rig.stereo_baseline_m = 0.54;
  scenario.rig.depth_camera = MountedDepthCamera{};
  scenario.rig.depth_camera->pack_from_camera.rotation = body_from_optical_rotation();
  const World world = edge_world();
  const RayScene rays(world);
  const Trajectory motion = sideways(0.0);
  FrameStream stream(scenario, {world, rays}, motion, 0);
  std::vector<int> ids;
  std::vector<double> columns;
  std::int64_t last_ns = 0;
  int depth_frames = 0;
  for (auto message = stream.next(); message; message = stream.next()) {
    EXPECT_GE(message->delivery_ns, last_ns);
    last_ns = message->delivery_ns;
    if (const auto* depth = std::get_if<DepthFrame>(&message->payload)) {
      EXPECT_EQ(depth->camera_id, kDepthCamera);
      EXPECT_NEAR(depth->depth_m[240 * 640 + 320], kEdgeDistance_m, 0.05);
      ++depth_frames;
    } else if (const auto* frame = std::get_if<CameraFrame>(&message->payload); frame && ids.size() < 2) {
      ids.push_back(frame->camera_id);
      columns.push_back(edge_in_row(*frame, 180).column);
    }
  }
  EXPECT_EQ(ids, (std::vector<int>{kMainCamera, kRightCamera}));
  const double disparity_px = intrinsics_of(scenario.rig.camera.model).fx * 0.54 / kEdgeDistance_m;
  EXPECT_NEAR(columns[0] - columns[1], disparity_px, 1.0);
  EXPECT_EQ(depth_frames, 30);
  const Calibration calibration = calibration_of(scenario.rig);
  ASSERT_EQ(calibration.further_cameras.size(), 2U);
  EXPECT_NEAR(calibration.further_cameras[0].body_from_camera.translation.y(), -0.54, 1e-12);
  EXPECT_EQ(calibration.further_cameras[1].camera_id, kDepthCamera);
}

TEST(ImageMotion, IsThatOfTheFastestPointSeen) {
  const World world = edge_world();
  const RayScene rays(world);
  const CameraModel model = catalogue_camera("wide640");
  const RenderView view = Lens(model, {}).view();
  const auto camera_at = [](double yaw, double y) {
    return Pose{rotation_from_rpy({0.0, 0.0, yaw}) * body_from_optical_rotation(), {-kEdgeDistance_m, y, 0.0}};
  };
  // Along the wall everything moves alike.
  EXPECT_NEAR(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0, 0.02), 0.0, 0.01}),
              view.fx * 0.02 / kEdgeDistance_m, 1e-6);
  // Turning moves the image's corners fastest.
  const double tangent = view.cx / view.fx;
  const double corner_px = 0.01 * view.fx * (1.0 + tangent * tangent);
  EXPECT_NEAR(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0.01, 0), 0.0, 0.01}), corner_px,
              0.05 * corner_px);
  EXPECT_LT(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0, 0), 0.0, 0.01}), 1e-9);
}

}  // namespace
}  // namespace plumbline
