#include "scenarios/catalogue.h"
#include "scenarios/mounting.h"
#include "scenarios/read_camera.h"
#include "scenarios/read_imu.h"
#include "scenarios/read_lidar.h"
#include "scenarios/read_sensor_errors.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kDecimation{1.0, 10.0};

/// What a rig is when a scenario says nothing of it.
RigConfig default_rig() {
  RigConfig config;
  config.pack_from_lidar.translation = kDefaultLidarInPack;
  config.camera.pack_from_camera = {body_from_optical_rotation(), kDefaultCameraInPack};
  config.lidar = catalogue_lidar("vlp16");
  config.camera.model = catalogue_camera("wide640");
  config.imu = catalogue_imu("bmi055");
  return config;
}

void read_lidar(ConfigReader& reader, std::uint64_t seed, RigConfig& config) {
  config.told_lidar_from_lidar = read_miscalibration(reader, seed, "lidar");
  config.pack_from_lidar = read_mounting(reader, kDefaultLidarInPack) * config.told_lidar_from_lidar;
  read_timing(reader, config.lidar_timing);
  read_lidar_device(reader, config);
}

}  // namespace

void read_rig(ConfigReader& reader, std::uint64_t seed, RigConfig& config) {
  config = default_rig();
  config.vehicle_from_pack = read_mounting(reader, Eigen::Vector3d::Zero());
  reader.read("decimation", config.decimation, kDecimation);
  reader.read("own_body", config.own_body);
  reader.section("lidar", [&](ConfigReader& lidar) { read_lidar(lidar, seed, config); });
  read_cameras(reader, seed, config);
  reader.section("imu", [&](ConfigReader& imu) { read_imu(imu, config); });
}

}  // namespace plumbline
