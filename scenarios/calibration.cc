#include "scenarios/calibration.h"

namespace plumbline {

Calibration calibration_of(const RigConfig& rig) {
  Calibration calibration;
  calibration.imu_rate_hz = rig.imu.rate_hz / rig.decimation;
  calibration.imu = rig.imu.noise;

  calibration.body_from_camera = rig.pack_from_camera;
  calibration.camera = intrinsics_of(rig.camera);
  calibration.camera_noise.electrons_per_dn = rig.camera.electrons_per_dn;
  calibration.camera_noise.read_noise_dn = rig.camera.read_noise_electrons / rig.camera.electrons_per_dn;
  calibration.camera_rate_hz = rig.camera.rate_hz / rig.decimation;

  calibration.body_from_lidar = rig.pack_from_lidar;
  calibration.lidar_rings = ring_count(rig.lidar);
  calibration.lidar_rate_hz = rig.lidar.rate_hz / messages_per_sweep(rig.lidar) / rig.decimation;  // sweeps
  calibration.lidar_range_sigma_m = rig.lidar.accuracy_sigma_m;
  calibration.lidar_min_range_m = rig.lidar.min_range_m;
  calibration.lidar_max_range_m = rig.lidar.max_range_m;
  return calibration;
}

}  // namespace plumbline
