#include "scenarios/calibration.h"

namespace plumbline {

namespace {

void add_cameras(const RigConfig& rig, const Pose& imu_from_pack, Calibration& calibration) {
  const CameraModel& model = rig.camera.model;
  const Pose camera_from_told = rig.camera.told_camera_from_camera.inverse();
  calibration.body_from_camera = imu_from_pack * rig.camera.pack_from_camera * camera_from_told;
  calibration.camera = intrinsics_of(model, rig.camera.effects);
  calibration.camera_noise.electrons_per_dn = model.chip.electrons_per_dn;
  calibration.camera_noise.read_noise_dn = model.chip.read_noise_electrons / model.chip.electrons_per_dn;
  calibration.camera_rate_hz = model.rate_hz / rig.decimation;
  if (rig.stereo_baseline_m) {
    calibration.further_cameras.push_back({kRightCamera, imu_from_pack * pack_from_right_camera(rig) * camera_from_told,
                                           calibration.camera, calibration.camera_rate_hz});
  }
  if (const auto& depth = rig.depth_camera) {
    calibration.further_cameras.push_back({kDepthCamera, imu_from_pack * depth->pack_from_camera,
                                           intrinsics_of(depth->model), depth->model.rate_hz / rig.decimation});
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

  // To the estimator, the body is the IMU.
  const Pose imu_from_pack{Eigen::Quaterniond::Identity(), -rig.imu.position_in_body};
  add_cameras(rig, imu_from_pack, calibration);

  calibration.has_lidar = rig.has_lidar;
  calibration.body_from_lidar = imu_from_pack * rig.pack_from_lidar * rig.told_lidar_from_lidar.inverse();
  calibration.lidar_rings = ring_count(rig.lidar);
  calibration.lidar_rate_hz = rig.lidar.rate_hz / messages_per_sweep(rig.lidar) / rig.decimation;  // sweeps
  calibration.lidar_range_sigma_m = rig.lidar.accuracy_sigma_m;
  calibration.lidar_min_range_m = rig.lidar.min_range_m;
  calibration.lidar_max_range_m = rig.lidar.max_range_m;
  return calibration;
}

}  // namespace plumbline
