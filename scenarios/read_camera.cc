#include "scenarios/read_camera.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "scenarios/mounting.h"
#include "scenarios/read_sensor_errors.h"
#include "scenarios/rig_reader.h"

namespace plumbline {
namespace {

constexpr Range kCameraRate_hz{0.1, 200.0};
constexpr Range kPixels{32.0, 4096.0};
constexpr Range kFieldOfView_deg{5.0, 160.0};
constexpr Range kBaseline_m{0.001, 5.0};

using Switches = std::initializer_list<std::pair<const char*, bool*>>;

/// `effects` by name; `noise: false` is short for all the noisy ones.
void read_switches(ConfigReader& reader, Switches noisy, Switches others) {
  bool noise = true;
  reader.read("noise", noise);
  reader.section("effects", [&](ConfigReader& effects) {
    for (const auto& [name, value] : noisy) effects.read(name, *value);
    for (const auto& [name, value] : others) effects.read(name, *value);
  });
  if (noise) return;
  for (const auto& [name, value] : noisy) *value = false;
}

void read_effects(ConfigReader& reader, CameraEffects& effects) {
  read_switches(reader,
                {{"shot_noise", &effects.shot_noise},
                 {"dark_current", &effects.dark_current},
                 {"read_noise", &effects.read_noise}},
                {{"motion_blur", &effects.motion_blur},
                 {"vignetting", &effects.vignetting},
                 {"distortion", &effects.distortion},
                 {"rolling_shutter", &effects.rolling_shutter}});
}

void read_effects(ConfigReader& reader, DepthCameraEffects& effects) {
  read_switches(reader, {{"disparity_noise", &effects.noise}},
                {{"quantisation", &effects.quantisation}, {"edges", &effects.edges}, {"shadow", &effects.shadow}});
}

Pose read_camera_mounting(ConfigReader& reader) {
  Pose pack_from_camera = read_mounting(reader, kDefaultCameraInPack);
  pack_from_camera.rotation = pack_from_camera.rotation * body_from_optical_rotation();
  return pack_from_camera;
}

template <typename Model>
void read_geometry(ConfigReader& reader, Model& model) {
  reader.read("rate_hz", model.rate_hz, kCameraRate_hz);
  reader.read("width", model.width, kPixels);
  reader.read("height", model.height, kPixels);
  reader.read("horizontal_fov_deg", model.horizontal_fov_deg, kFieldOfView_deg);
}

void read_camera(ConfigReader& reader, MountedCamera& camera) {
  camera.pack_from_camera = read_camera_mounting(reader);
  read_model(reader, "camera", catalogue_camera, camera.model);
  read_geometry(reader, camera.model);
  read_lens_and_shutter(reader, camera.model);
  camera.model.exposure.max_exposure_s = std::min(camera.model.exposure.max_exposure_s, 1.0 / camera.model.rate_hz);
  read_effects(reader, camera.effects);
  check_model(reader, camera.model);
}

/// @param told_mount_from_mount  of a mount with x forward, as a file's angles are; the camera looks along z
void misplace(const Pose& told_mount_from_mount, MountedCamera& camera) {
  const Pose mount_from_camera{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
  camera.told_camera_from_camera = mount_from_camera.inverse() * told_mount_from_mount * mount_from_camera;
  camera.pack_from_camera = camera.pack_from_camera * camera.told_camera_from_camera;
}

void require_colour(const ConfigReader& reader, const MountedCamera& camera, bool colour) {
  if (camera.model.colour != colour) {
    fail_at(reader.node(), reader.path_of("model"), colour ? "a colour camera" : "a grey camera");
  }
}

MountedDepthCamera read_depth_camera(ConfigReader& reader) {
  MountedDepthCamera camera;
  camera.pack_from_camera = read_camera_mounting(reader);
  camera.model = catalogue_depth_camera("xtion");
  read_model(reader, "depth_camera", catalogue_depth_camera, camera.model);
  read_geometry(reader, camera.model);
  read_effects(reader, camera.effects);
  check_model(reader, camera.model);
  return camera;
}

MountedCamera read_colour_camera(ConfigReader& reader) {
  MountedCamera camera;
  camera.model = catalogue_camera("contour_colour");
  read_camera(reader, camera);
  require_colour(reader, camera, true);
  return camera;
}

}  // namespace

void read_lens_and_shutter(ConfigReader& reader, CameraModel& model) {
  constexpr Range kCoefficient{-10.0, 10.0};
  std::vector<double> coefficients;
  if (const ConfigNode* node = reader.find("distortion");
      node && reader.read("distortion", coefficients, kCoefficient)) {
    if (coefficients.size() != 4) fail_at(*node, reader.path_of("distortion"), "[k1, k2, p1, p2]");
    model.distortion = {coefficients[0], coefficients[1], coefficients[2], coefficients[3]};
  }
  std::size_t shutter = model.rolling_shutter ? 1 : 0;
  reader.read_choice("shutter", {"global", "rolling"}, shutter);
  model.rolling_shutter = shutter == 1;
}

void read_cameras(ConfigReader& rig, std::uint64_t seed, RigConfig& config) {
  rig.section("camera", [&](ConfigReader& reader) {
    read_timing(reader, config.camera_timing);
    read_camera(reader, config.camera);
    misplace(read_miscalibration(reader, seed, "camera"), config.camera);
    require_colour(reader, config.camera, false);
  });
  rig.section("stereo", [&](ConfigReader& reader) {
    config.stereo_baseline_m = 0.1;
    reader.read("baseline_m", *config.stereo_baseline_m, kBaseline_m);
  });
  rig.section("depth_camera", [&](ConfigReader& reader) { config.depth_camera = read_depth_camera(reader); });
  rig.section("colour_camera", [&](ConfigReader& reader) { config.colour_camera = read_colour_camera(reader); });
}

}  // namespace plumbline
