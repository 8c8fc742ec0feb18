#include "scenarios/calibration.h"

#include <cmath>

namespace plumbline {

Calibration calibration_of(const RigConfig& rig) {
  Calibration calibration;
  calibration.imu_rate_hz = rig.imu.rate_hz / rig.decimation;
  calibration.imu = rig.imu.noise;

  // To the estimator, the body is the IMU.
  const Pose imu_from_pack{Eigen::Quaterniond::Identity(), -rig.imu.position_in_body};
  calibration.body_from_camera = imu_from_pack * rig.pack_from_camera * rig.told_camera_from_camera.inverse();
  calibration.camera = intrinsics_of(rig.camera);
  calibration.camera_noise.electrons_per_dn = rig.camera.electrons_per_dn;
  calibration.camera_noise.read_noise_dn = rig.camera.read_noise_electrons / rig.camera.electrons_per_dn;
  calibration.camera_rate_hz = rig.camera.rate_hz / rig.decimation;

  calibration.body_from_lidar = imu_from_pack * rig.pack_from_lidar * rig.told_lidar_from_lidar.inverse();
  calibration.lidar_rings = static_cast<int>(rig.lidar.elevation_deg.size());
  calibration.lidar_rate_hz = rig.lidar.rate_hz / rig.decimation;
  calibration.lidar_range_sigma_m = std::hypot(rig.lidar.range_sigma_m, rig.lidar.ring_bias_sigma_m);
  calibration.lidar_min_range_m = rig.lidar.min_range_m;
  calibration.lidar_max_range_m = rig.lidar.max_range_m;
  return calibration;
}

}  // namespace plumbline
