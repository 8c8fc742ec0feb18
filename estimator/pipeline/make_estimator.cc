#include <algorithm>
#include <stdexcept>

#include "estimator/estimator.h"
#include "estimator/pipeline/demo.h"
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
    case Module::kLocalization:
      return "localization";
  }
  return "";
}

std::string_view to_string(MapAgreement agreement) {
  switch (agreement) {
    case MapAgreement::kAgrees:
      return "agrees";
    case MapAgreement::kUnconfirmed:
      return "unconfirmed";
    case MapAgreement::kUndetermined:
      return "undetermined";
    case MapAgreement::kOffMap:
      return "off the map";
    case MapAgreement::kDisagrees:
      return "disagrees";
    case MapAgreement::kTooFar:
      return "too far";
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
      {"joint", "IMU prediction, and one problem of lidar and camera rows at every scan"},
      {"imu", "dead reckoning"},
      {"loam", "lidar odometry within each sweep and mapping once a sweep, with or without the IMU (LOAM)"},
      {"loam_imu_orientation", "the same with the attitude as the gyro integrates it; only translation is estimated"},
      {"demo", "frame-to-frame visual odometry with depth and bundle adjustment, no IMU (DEMO)"},
      {"demo_no_ba", "the same without bundle adjustment"},
      {"demo_matched", "frame-to-frame visual odometry and scan matching, no IMU (DEMO + scan matching)"},
      {"demo_loam", "frame-to-frame visual odometry, refined sweep to sweep and sweep to map, no IMU (three stages)"},
      {"demo_loam_prior", "the same with a constant prior in place of solution remapping"},
      {"vo_depth_only", "frame-to-frame visual odometry that uses only features with measured depth, no IMU"},
  };
  return library;
}

namespace {

std::unique_ptr<Estimator> make_vloam(const std::string& name, const Calibration& calibration,
                                      const EstimatorConfig& config) {
  EstimatorConfig chosen = config;
  if (name == "vio" || name == "imu") chosen.lidar_enabled = false;
  if (name == "imu_lidar" || name == "imu") chosen.vision_enabled = false;
  const Coupling coupling = name == "joint" ? Coupling::kJoint : Coupling::kSequential;
  return std::make_unique<Vloam>(calibration, chosen, coupling);
}

std::unique_ptr<Estimator> make_demo(const std::string& name, const Calibration& calibration,
                                     const EstimatorConfig& config) {
  DemoConfig stages;
  // Matched to the map every sweep, the motion is corrected long before a window of forty images is full.
  stages.bundle_adjustment = name == "demo";
  stages.map_depth_only = name == "vo_depth_only";
  stages.scan_matching = name == "demo_matched" || name == "vloam";
  stages.constant_prior = name == "demo_loam_prior";
  stages.sweep_refinement = name == "demo_loam" || stages.constant_prior;
  return std::make_unique<Demo>(calibration, config, stages);
}

std::unique_ptr<Estimator> make_loam(const std::string& name, const Calibration& calibration,
                                     const EstimatorConfig& config) {
  if (name == "loam_imu_orientation") return std::make_unique<Loam>(calibration, config, ImuUse::kOrientation);
  return std::make_unique<Loam>(calibration, config, config.imu_enabled ? ImuUse::kFull : ImuUse::kNone);
}

/// Motion that nothing predicts has to be seen within the sweep: by the camera, as in thesis ch. 6, or, without one, by
/// the sweep itself.
std::unique_ptr<Estimator> make_without_imu(const std::string& name, const Calibration& calibration,
                                            const EstimatorConfig& config) {
  const bool sees = calibration.has_camera && config.vision_enabled;
  if (name == "vio" || (name == "vloam" && sees)) return make_demo(name, calibration, config);
  if (name == "imu_lidar" || name == "vloam") return make_loam(name, calibration, config);
  throw std::invalid_argument("estimator: '" + name + "' needs the IMU, which estimator.imu.enabled switches off");
}

constexpr double kCoarsest = 20.0;  // fewer features than that leaves are too few to match

void validate_or_throw(const std::string& name, const Calibration& calibration, const EstimatorConfig& config) {
  const auto& library = estimator_library();
  if (std::none_of(library.begin(), library.end(), [&](const EstimatorInfo& info) { return info.name == name; })) {
    std::string known;
    for (const EstimatorInfo& info : library) known += (known.empty() ? "" : ", ") + info.name;
    throw std::invalid_argument("estimator: unknown name '" + name + "'; known: " + known);
  }
  if (calibration.has_camera && (calibration.camera.width <= 0 || calibration.camera.height <= 0 ||
                                 !(calibration.camera.fx > 0.0) || !(calibration.camera.fy > 0.0))) {
    throw std::invalid_argument("estimator: camera intrinsics must be positive");
  }
  if (!(config.feature_share > 0.0 && config.feature_share <= 1.0)) {
    throw std::invalid_argument("estimator: the share of features must be above 0 and at most 1");
  }
  if (!(config.resolution_factor >= 1.0 && config.resolution_factor <= kCoarsest)) {
    throw std::invalid_argument("estimator: the resolution factor must be 1 to 20");
  }
}

}  // namespace

std::unique_ptr<Estimator> make_estimator(const std::string& name, const Calibration& calibration,
                                          const EstimatorConfig& config) {
  validate_or_throw(name, calibration, config);
  if (name.starts_with("loam")) return make_loam(name, calibration, config);
  const bool demo = name.starts_with("demo") || name == "vo_depth_only";
  if (demo) return make_demo(name, calibration, config);
  return config.imu_enabled ? make_vloam(name, calibration, config) : make_without_imu(name, calibration, config);
}

}  // namespace plumbline
