#include <algorithm>
#include <stdexcept>

#include "estimator/estimator.h"
#include "estimator/pipeline/loam.h"
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
      {"loam", "lidar odometry within each sweep and mapping once a sweep, with or without the IMU (LOAM)"},
      {"loam_imu_orientation", "the same with the attitude as the gyro integrates it; only translation is estimated"},
  };
  return library;
}

std::unique_ptr<Estimator> make_estimator(const std::string& name, const Calibration& calibration,
                                          const EstimatorConfig& config) {
  const std::vector<EstimatorInfo>& library = estimator_library();
  const auto is_named = [&](const EstimatorInfo& info) { return info.name == name; };
  if (std::none_of(library.begin(), library.end(), is_named)) {
    std::string known;
    for (const EstimatorInfo& info : library) known += (known.empty() ? "" : ", ") + info.name;
    throw std::invalid_argument("estimator: unknown name '" + name + "'; known: " + known);
  }
  if (name == "loam") {
    return std::make_unique<Loam>(calibration, config, config.imu_enabled ? ImuUse::kFull : ImuUse::kNone);
  }
  if (name == "loam_imu_orientation") return std::make_unique<Loam>(calibration, config, ImuUse::kOrientation);
  EstimatorConfig chosen = config;
  if (name == "vio" || name == "imu") chosen.lidar_enabled = false;
  if (name == "imu_lidar" || name == "imu") chosen.vision_enabled = false;
  if (calibration.has_camera && (calibration.camera.width <= 0 || calibration.camera.height <= 0 ||
                                 !(calibration.camera.fx > 0.0) || !(calibration.camera.fy > 0.0))) {
    throw std::invalid_argument("estimator: camera intrinsics must be positive");
  }
  return std::make_unique<Vloam>(calibration, chosen);
}

}  // namespace plumbline
