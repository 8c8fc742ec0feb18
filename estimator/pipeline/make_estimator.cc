#include <stdexcept>

#include "estimator/estimator.h"
#include "estimator/pipeline/vloam.h"

namespace plumbline {

std::string_view to_string(Module module) {
  switch (module) {
    case Module::kImu:
      return "imu";
    case Module::kVision:
      return "vision";
    case Module::kLidar:
      return "lidar";
  }
  return "";
}

std::string_view to_string(ModuleMode mode) {
  switch (mode) {
    case ModuleMode::kSolved:
      return "solved";
    case ModuleMode::kPartial:
      return "partial";
    case ModuleMode::kBypassed:
      return "bypassed";
  }
  return "";
}

const std::vector<EstimatorInfo>& estimator_library() {
  static const std::vector<EstimatorInfo> library{
      {"vloam", "IMU prediction, visual odometry with lidar depth, scan matching (V-LOAM)"},
      {"vio", "IMU prediction and visual odometry with lidar depth; scan matching off"},
      {"imu_lidar", "IMU prediction and scan matching; vision off"},
      {"imu", "dead reckoning"},
  };
  return library;
}

std::unique_ptr<Estimator> make_estimator(const std::string& name, const Calibration& calibration,
                                          const EstimatorConfig& config) {
  EstimatorConfig chosen = config;
  if (name == "vio" || name == "imu") chosen.lidar_enabled = false;
  if (name == "imu_lidar" || name == "imu") chosen.vision_enabled = false;
  const bool known = name == "vloam" || name == "vio" || name == "imu_lidar" || name == "imu";
  if (!known) throw std::invalid_argument("estimator: unknown name '" + name + "'; known: vloam, vio, imu_lidar, imu");
  if (calibration.has_camera && (calibration.camera.width <= 0 || calibration.camera.height <= 0 ||
                                 !(calibration.camera.fx > 0.0) || !(calibration.camera.fy > 0.0))) {
    throw std::invalid_argument("estimator: camera intrinsics must be positive");
  }
  return std::make_unique<Vloam>(calibration, chosen);
}

}  // namespace plumbline
