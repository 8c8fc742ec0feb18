#include <algorithm>

#include "scenarios/catalogue.h"
#include "scenarios/input_error.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kOffset_m{-10.0, 10.0};
constexpr Range kAngle_deg{-180.0, 180.0};
constexpr Range kDecimation{1.0, 10.0};
constexpr Range kLidarRate_hz{1.0, 50.0};
constexpr Range kCameraRate_hz{1.0, 200.0};
constexpr Range kImuRate_hz{50.0, 1000.0};
constexpr Range kPixels{32.0, 4096.0};
constexpr double kDegree = M_PI / 180.0;

/// The six keys of a mounting: where the thing sits, and how it is turned.
Pose read_mounting(ConfigReader& reader, Eigen::Vector3d position) {
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  reader.read("x_m", position.x(), kOffset_m);
  reader.read("y_m", position.y(), kOffset_m);
  reader.read("z_m", position.z(), kOffset_m);
  reader.read("roll_deg", rpy_deg.x(), kAngle_deg);
  reader.read("pitch_deg", rpy_deg.y(), kAngle_deg);
  reader.read("yaw_deg", rpy_deg.z(), kAngle_deg);
  return {rotation_from_rpy(rpy_deg * kDegree), position};
}

/// Replaces a model by the catalogue's of that name.
template <typename Model>
void read_model(ConfigReader& reader, const std::string& kind, Model (*from_catalogue)(const std::string&),
                Model& model) {
  const std::vector<std::string> names = catalogue_names(kind);
  std::size_t index = 0;
  if (reader.read_choice("model", names, index)) model = from_catalogue(names[index]);
}

/// The model's own rules, which know how its figures hang together.
template <typename Model>
void check_model(const ConfigReader& reader, const Model& model) {
  try {
    validate_or_throw(model);
  } catch (const std::invalid_argument& error) {
    throw InputError(reader.node().where + ": " + reader.path() + ": " + error.what());
  }
}

/// What a rig is when a scenario says nothing of it.
RigConfig default_rig() {
  RigConfig config;
  config.pack_from_lidar.translation = kDefaultLidarInPack;
  config.pack_from_camera = {body_from_optical_rotation(), kDefaultCameraInPack};
  config.lidar = catalogue_lidar("vlp16");
  config.camera = catalogue_camera("wide640");
  config.imu = catalogue_imu("bmi055");
  return config;
}

void read_lidar(ConfigReader& reader, RigConfig& config) {
  config.pack_from_lidar = read_mounting(reader, kDefaultLidarInPack);
  read_model(reader, "lidar", catalogue_lidar, config.lidar);
  reader.read("rate_hz", config.lidar.rate_hz, kLidarRate_hz);
  reader.read("noise", config.lidar_noise);
  check_model(reader, config.lidar);
}

void read_camera(ConfigReader& reader, RigConfig& config) {
  config.pack_from_camera = read_mounting(reader, kDefaultCameraInPack);
  config.pack_from_camera.rotation = config.pack_from_camera.rotation * body_from_optical_rotation();
  read_model(reader, "camera", catalogue_camera, config.camera);
  reader.read("rate_hz", config.camera.rate_hz, kCameraRate_hz);
  config.camera.max_exposure_s = std::min(config.camera.max_exposure_s, 1.0 / config.camera.rate_hz);
  reader.read("width", config.camera.width, kPixels);
  reader.read("height", config.camera.height, kPixels);
  reader.read("noise", config.camera_noise);
  check_model(reader, config.camera);
}

void read_imu(ConfigReader& reader, RigConfig& config) {
  read_model(reader, "imu", catalogue_imu, config.imu);
  reader.read("rate_hz", config.imu.rate_hz, kImuRate_hz);
  reader.read("noise", config.imu_noise);
  check_model(reader, config.imu);
}

}  // namespace

void read_rig(ConfigReader& reader, RigConfig& config) {
  config = default_rig();
  config.vehicle_from_pack = read_mounting(reader, Eigen::Vector3d::Zero());
  reader.read("decimation", config.decimation, kDecimation);
  reader.read("own_body", config.own_body);
  reader.section("lidar", [&](ConfigReader& lidar) { read_lidar(lidar, config); });
  reader.section("camera", [&](ConfigReader& camera) { read_camera(camera, config); });
  reader.section("imu", [&](ConfigReader& imu) { read_imu(imu, config); });
}

}  // namespace plumbline
