#include "scenarios/calibration.h"

namespace plumbline {

namespace {

void add_cameras(const RigConfig& rig, Calibration& calibration) {
  const CameraModel& model = rig.camera.model;
  calibration.body_from_camera = rig.camera.pack_from_camera;
  calibration.camera = intrinsics_of(model, rig.camera.effects);
  calibration.camera_noise.electrons_per_dn = model.chip.electrons_per_dn;
  calibration.camera_noise.read_noise_dn = model.chip.read_noise_electrons / model.chip.electrons_per_dn;
  calibration.camera_rate_hz = model.rate_hz / rig.decimation;
  if (rig.stereo_baseline_m) {
    calibration.further_cameras.push_back(
        {kRightCamera, pack_from_right_camera(rig), calibration.camera, calibration.camera_rate_hz});
  }
  if (const auto& depth = rig.depth_camera) {
    calibration.further_cameras.push_back(
        {kDepthCamera, depth->pack_from_camera, intrinsics_of(depth->model), depth->model.rate_hz / rig.decimation});
  }
}

}  // namespace

Pose pack_from_right_camera(const RigConfig& rig) {
  Pose right = rig.camera.pack_from_camera;
  right.translation += right.rotation * Eigen::Vector3d(rig.stereo_baseline_m.value(), 0.0, 0.0);
  return right;
}

Calibration calibration_of(const RigConfig& rig) {
  Calibration calibration;
  calibration.imu_rate_hz = rig.imu.rate_hz / rig.decimation;
  calibration.imu = rig.imu.noise;

  add_cameras(rig, calibration);

  calibration.body_from_lidar = rig.pack_from_lidar;
  calibration.lidar_rings = ring_count(rig.lidar);
  calibration.lidar_rate_hz = rig.lidar.rate_hz / messages_per_sweep(rig.lidar) / rig.decimation;  // sweeps
  calibration.lidar_range_sigma_m = rig.lidar.accuracy_sigma_m;
  calibration.lidar_min_range_m = rig.lidar.min_range_m;
  calibration.lidar_max_range_m = rig.lidar.max_range_m;
  return calibration;
}

}  // namespace plumbline
