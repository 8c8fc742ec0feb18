#include "scenarios/catalogue.h"
#include "scenarios/mounting.h"
#include "scenarios/read_camera.h"
#include "scenarios/read_lidar.h"
#include "scenarios/rig_reader.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kDecimation{1.0, 10.0};
constexpr Range kImuRate_hz{50.0, 1000.0};

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

void read_lidar(ConfigReader& reader, RigConfig& config) {
  config.pack_from_lidar = read_mounting(reader, kDefaultLidarInPack);
  read_lidar_device(reader, config);
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
  reader.section("lidar", [&](ConfigReader& lidar) { read_lidar(lidar, config); });
  read_cameras(reader, config);
  reader.section("imu", [&](ConfigReader& imu) { read_imu(imu, config); });
}

}  // namespace plumbline
