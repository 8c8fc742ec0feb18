#include "tools/verify/moving_edge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenarios/calibration.h"
#include "scenarios/catalogue.h"
#include "scenarios/frame_stream.h"
#include "sim/ray_scene.h"

namespace plumbline {

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

Trajectory sideways(double speed_mps) {
  std::vector<PoseTrack::Stamped> poses;
  for (int i = 0; i <= 100; ++i) {
    const double time_s = 0.01 * i;
    poses.push_back({static_cast<std::int64_t>(i) * 10'000'000,
                     {Eigen::Quaterniond::Identity(), {-kEdgeDistance_m, speed_mps * (time_s - 0.5), 0.0}}});
  }
  return Trajectory(poses);
}

Scenario edge_scenario(const CameraModel& model) {
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

CameraFrame middle_frame(const Scenario& scenario, double speed_mps) {
  const World world = edge_world();
  const RayScene rays(world);
  const Trajectory motion = sideways(speed_mps);
  FrameStream stream(scenario, {world, rays}, motion, 0);
  CameraFrame frame;
  for (auto message = stream.next(); message && message->delivery_ns <= 500'000'000; message = stream.next()) {
    if (const auto* seen = std::get_if<CameraFrame>(&message->payload); seen && seen->camera_id == 0) frame = *seen;
  }
  return frame;
}

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

BlurCheck check_blur(double speed_mps, double exposure_s) {
  const CameraModel model = exposed_for(exposure_s);
  Scenario scenario = edge_scenario(model);
  // Rolled a little, so that the rows see the edge at all fractions of a pixel: single rows are off by up to one.
  Eigen::Quaterniond& rotation = scenario.rig.camera.pack_from_camera.rotation;
  rotation = rotation * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ());
  return {speed_mps, exposure_s, mean_blur_px(middle_frame(scenario, speed_mps)),
          intrinsics_of(model).fx * speed_mps * exposure_s / kEdgeDistance_m};
}

}  // namespace plumbline
