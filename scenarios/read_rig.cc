#include <algorithm>

#include "scenarios/catalogue_file.h"
#include "scenarios/read_imu.h"
#include "scenarios/read_sensor_errors.h"
#include "scenarios/rig_reader.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kOffset_m{-10.0, 10.0};
constexpr Range kAngle_deg{-180.0, 180.0};
constexpr Range kDecimation{1.0, 10.0};
constexpr Range kLidarRate_hz{1.0, 50.0};
constexpr Range kCameraRate_hz{1.0, 200.0};
constexpr Range kPixels{32.0, 4096.0};

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

void read_lidar(ConfigReader& reader, std::uint64_t seed, RigConfig& config) {
  config.told_lidar_from_lidar = read_miscalibration(reader, seed, "lidar");
  config.pack_from_lidar = read_mounting(reader, kDefaultLidarInPack) * config.told_lidar_from_lidar;
  read_timing(reader, config.lidar_timing);
  read_model(reader, "lidar", catalogue_lidar, config.lidar);
  reader.read("rate_hz", config.lidar.rate_hz, kLidarRate_hz);
  reader.read("noise", config.lidar_noise);
  check_model(reader, config.lidar);
}

void read_camera(ConfigReader& reader, std::uint64_t seed, RigConfig& config) {
  // Angles in a file are those of a mount with x forward; the camera looks along z.
  const Pose mount_from_camera{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
  const Pose told_mount_from_mount = read_miscalibration(reader, seed, "camera");
  config.told_camera_from_camera = mount_from_camera.inverse() * told_mount_from_mount * mount_from_camera;
  config.pack_from_camera = read_mounting(reader, kDefaultCameraInPack) * told_mount_from_mount * mount_from_camera;
  read_timing(reader, config.camera_timing);
  read_model(reader, "camera", catalogue_camera, config.camera);
  reader.read("rate_hz", config.camera.rate_hz, kCameraRate_hz);
  config.camera.max_exposure_s = std::min(config.camera.max_exposure_s, 1.0 / config.camera.rate_hz);
  reader.read("width", config.camera.width, kPixels);
  reader.read("height", config.camera.height, kPixels);
  reader.read("noise", config.camera_noise);
  check_model(reader, config.camera);
}

}  // namespace

void read_rig(ConfigReader& reader, std::uint64_t seed, RigConfig& config) {
  config = default_rig();
  config.vehicle_from_pack = read_mounting(reader, Eigen::Vector3d::Zero());
  reader.read("decimation", config.decimation, kDecimation);
  reader.section("lidar", [&](ConfigReader& lidar) { read_lidar(lidar, seed, config); });
  reader.section("camera", [&](ConfigReader& camera) { read_camera(camera, seed, config); });
  reader.section("imu", [&](ConfigReader& imu) { read_imu(imu, config); });
}

}  // namespace plumbline
