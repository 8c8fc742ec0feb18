// Moving cameras: what their frames show against what they must.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scenarios/calibration.h"
#include "scenarios/catalogue.h"
#include "scenarios/frame_stream.h"
#include "sensors/image_motion.h"
#include "sim/ray_scene.h"

namespace plumbline {
namespace {

constexpr double kDistance_m = 2.0;

/// A wall across the view, dark to the left of the x-z plane and bright to the right.
World edge_world() {
  SceneDescription scene;
  scene.mjcf =
      R"(<mujoco><asset><material name="dark"/><material name="bright"/></asset><worldbody>
      <geom type="box" material="dark" pos="0.5 10 0" size="0.5 10 10"/>
      <geom type="box" material="bright" pos="0.5 -10 0" size="0.5 10 10"/></worldbody></mujoco>)";
  scene.materials = {{.name = "dark", .pattern = Material::Pattern::kPlain, .albedo = 0.1F, .contrast = 0.0F},
                     {.name = "bright", .pattern = Material::Pattern::kPlain, .albedo = 0.8F, .contrast = 0.0F}};
  scene.ambient_lux = 600.0;
  return World::from_scene(scene, 1);
}

/// To the left at constant speed, past the edge at half a second.
Trajectory sideways(double speed_mps) {
  std::vector<PoseTrack::Stamped> poses;
  for (int i = 0; i <= 100; ++i) {
    const double time_s = 0.01 * i;
    poses.push_back({static_cast<std::int64_t>(i) * 10'000'000,
                     {Eigen::Quaterniond::Identity(), {-kDistance_m, speed_mps * (time_s - 0.5), 0.0}}});
  }
  return Trajectory(poses);
}

Scenario scenario_with(const CameraModel& model) {
  Scenario scenario;
  scenario.rig.camera.model = model;
  scenario.rig.camera.pack_from_camera.rotation = body_from_optical_rotation();
  CameraEffects& effects = scenario.rig.camera.effects;
  effects.shot_noise = effects.read_noise = effects.dark_current = effects.vignetting = false;
  return scenario;
}

CameraModel exposed_for(double exposure_s) {
  CameraModel model = catalogue_camera("wide640");
  model.exposure.min_exposure_s = model.exposure.max_exposure_s = exposure_s;
  model.exposure.row_time_s = 0.0;
  model.exposure.max_gain = 1.0;
  return model;
}

/// The frame of camera 0 nearest to half a second.
CameraFrame middle_frame(const Scenario& scenario, double speed_mps) {
  const World world = edge_world();
  const RayScene rays(world);
  const Trajectory motion = sideways(speed_mps);
  FrameStream stream(scenario, {world, rays}, motion);
  CameraFrame frame;
  for (auto message = stream.next(); message && message->delivery_ns <= 500'000'000; message = stream.next()) {
    if (const auto* seen = std::get_if<CameraFrame>(&message->payload); seen && seen->camera_id == 0) frame = *seen;
  }
  return frame;
}

/// Where an edge lies in a row, and how wide a box would blur it alike: from mean and variance of the row's slope.
struct Edge {
  double column = 0.0;
  double width_px = 0.0;
};

Edge edge_in_row(const CameraFrame& frame, int row) {
  double weight = 0.0;
  double mean = 0.0;
  double square = 0.0;
  for (int u = 0; u + 1 < frame.width; ++u) {
    const auto at = [&](int column) { return frame.pixels[static_cast<std::size_t>(row * frame.width + column)]; };
    const double slope = static_cast<double>(at(u + 1)) - at(u);
    weight += slope;
    mean += slope * (u + 0.5);
    square += slope * (u + 0.5) * (u + 0.5);
  }
  mean /= weight;
  return {mean, std::sqrt(12.0 * std::max(square / weight - mean * mean, 0.0))};
}

double mean_blur_px(const CameraFrame& frame) {
  double sum = 0.0;
  for (int row = 100; row < 260; ++row) sum += edge_in_row(frame, row).width_px;
  return sum / 160.0;
}

TEST(CameraOnRig, BlurIsSpeedTimesExposure) {
  for (const double speed_mps : {2.0, 4.0, 8.0}) {
    const CameraModel model = exposed_for(6e-3);
    const double expected_px = intrinsics_of(model).fx * speed_mps * 6e-3 / kDistance_m;  // 2.8, 5.7 and 11.4
    Scenario scenario = scenario_with(model);
    // Rolled a little, so that the rows see the edge at all fractions of a pixel: single rows are off by up to one.
    Eigen::Quaterniond& rotation = scenario.rig.camera.pack_from_camera.rotation;
    rotation = rotation * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(mean_blur_px(middle_frame(scenario, speed_mps)), expected_px, 0.2) << speed_mps;
  }
}

TEST(CameraOnRig, BlurCanBeSwitchedOff) {
  Scenario scenario = scenario_with(exposed_for(6e-3));
  scenario.rig.camera.effects.motion_blur = false;
  EXPECT_LT(mean_blur_px(middle_frame(scenario, 4.0)), 0.5);
}

TEST(CameraOnRig, ARollingShutterLeansTheEdgeAsFarAsTheImageMovesMeanwhile) {
  CameraModel model = exposed_for(1e-3);
  model.rolling_shutter = true;
  model.exposure.row_time_s = 30e-6;
  const double px_per_s = intrinsics_of(model).fx * 3.0 / kDistance_m;
  const CameraFrame leaning = middle_frame(scenario_with(model), 3.0);
  Scenario global = scenario_with(model);
  global.rig.camera.effects.rolling_shutter = false;
  const CameraFrame upright = middle_frame(global, 3.0);
  for (const int row : {10, 100, 180, 260, 350}) {
    const double lag_s = (row - 179.5) * 30e-6;  // later rows see the camera farther left, the edge farther right
    const double lean_px = edge_in_row(leaning, row).column - edge_in_row(upright, row).column;
    EXPECT_NEAR(lean_px, px_per_s * lag_s, 0.6) << row;  // a picture a pixel
  }
}

TEST(CameraOnRig, TheSameSeedGivesTheSameBytes) {
  Scenario scenario = scenario_with(exposed_for(6e-3));
  scenario.rig.camera.model.width = 160;
  scenario.rig.camera.model.height = 90;
  scenario.rig.camera.effects = {};
  const std::vector<std::uint8_t> once = middle_frame(scenario, 4.0).pixels;
  EXPECT_EQ(once, middle_frame(scenario, 4.0).pixels);
  scenario.seed = 2;
  EXPECT_NE(once, middle_frame(scenario, 4.0).pixels);
}

TEST(CameraOnRig, TheSecondEyeSeesTheEdgeByItsBaseline) {
  Scenario scenario = scenario_with(exposed_for(1e-3));
  scenario.rig.stereo_baseline_m = 0.54;
  scenario.rig.depth_camera = MountedDepthCamera{};
  scenario.rig.depth_camera->pack_from_camera.rotation = body_from_optical_rotation();
  const World world = edge_world();
  const RayScene rays(world);
  const Trajectory motion = sideways(0.0);
  FrameStream stream(scenario, {world, rays}, motion);
  std::vector<int> ids;
  std::vector<double> columns;
  std::int64_t last_ns = 0;
  int depth_frames = 0;
  for (auto message = stream.next(); message; message = stream.next()) {
    EXPECT_GE(message->delivery_ns, last_ns);
    last_ns = message->delivery_ns;
    if (const auto* depth = std::get_if<DepthFrame>(&message->payload)) {
      EXPECT_EQ(depth->camera_id, kDepthCamera);
      EXPECT_NEAR(depth->depth_m[240 * 640 + 320], kDistance_m, 0.05);
      ++depth_frames;
    } else if (const auto* frame = std::get_if<CameraFrame>(&message->payload); frame && ids.size() < 2) {
      ids.push_back(frame->camera_id);
      columns.push_back(edge_in_row(*frame, 180).column);
    }
  }
  EXPECT_EQ(ids, (std::vector<int>{kMainCamera, kRightCamera}));
  const double disparity_px = intrinsics_of(scenario.rig.camera.model).fx * 0.54 / kDistance_m;
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
    return Pose{rotation_from_rpy({0.0, 0.0, yaw}) * body_from_optical_rotation(), {-kDistance_m, y, 0.0}};
  };
  // Along the wall everything moves alike.
  EXPECT_NEAR(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0, 0.02), 0.0, 0.01}),
              view.fx * 0.02 / kDistance_m, 1e-6);
  // Turning moves the image's corners fastest.
  const double tangent = view.cx / view.fx;
  const double corner_px = 0.01 * view.fx * (1.0 + tangent * tangent);
  EXPECT_NEAR(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0.01, 0), 0.0, 0.01}), corner_px,
              0.05 * corner_px);
  EXPECT_LT(image_motion_px({world, rays}, view, {camera_at(0, 0), camera_at(0, 0), 0.0, 0.01}), 1e-9);
}

}  // namespace
}  // namespace plumbline
