#include "scenarios/calibration.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

#include "sim/geom_mesh.h"
#include "sim/vehicles/vehicle.h"
#include "sim/world.h"

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

/// In the vehicle's frame: a box about every geom, along the geom's axes.
std::vector<OwnPart> parts_of(const World& vehicle) {
  constexpr double kTolerance_m = 1e-3;
  std::vector<OwnPart> parts;
  for (int geom = 0; geom < vehicle.model().ngeom; ++geom) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& vertex : mesh_of_geom(vehicle.model(), geom, kTolerance_m, 0.0).vertices) {
      box.extend(vertex.cast<double>());
    }
    if (box.isEmpty()) continue;
    OwnPart part{vehicle.pose_of_geom(geom), box.sizes() / 2.0};
    part.body_from_part.translation = part.body_from_part * box.center();
    parts.push_back(part);
  }
  return parts;
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

Calibration calibration_of(const Scenario& scenario) {
  Calibration calibration = calibration_of(scenario.rig);
  if (!scenario.rig.own_body || scenario.motion.vehicle.empty()) return calibration;
  const VehicleInfo& vehicle = vehicle_named(scenario.motion.vehicle);
  if (vehicle.body == nullptr) return calibration;
  calibration.own_body = parts_of(World::from_scene(vehicle.body(), scenario.seed));
  const Pose imu_from_pack{Eigen::Quaterniond::Identity(), -scenario.rig.imu.position_in_body};
  const Pose body_from_vehicle = imu_from_pack * scenario.rig.vehicle_from_pack.inverse();
  for (OwnPart& part : calibration.own_body) part.body_from_part = body_from_vehicle * part.body_from_part;
  return calibration;
}

}  // namespace plumbline
