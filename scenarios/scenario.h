#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/input_error.h"
#include "sensors/camera_model.h"
#include "sensors/clock.h"
#include "sensors/depth_camera.h"
#include "sensors/faults.h"
#include "sensors/imu.h"
#include "sensors/lidar.h"
#include "sim/motion.h"
#include "sim/scene_library.h"
#include "sim/world.h"

namespace plumbline {

struct WorldConfig {
  std::string scene = "garage";  ///< a name of scene_library(), or empty with `mjcf` set
  std::filesystem::path mjcf;    ///< a user's MJCF
  SceneValues parameters;
  std::optional<std::uint64_t> seed;  ///< otherwise the scenario's
  double usual_lux = kLampLightLux;   ///< the scene's level under lamps
  /// Otherwise usual_lux under lamps, and in sunlight and at night what the scene says.
  std::optional<double> light_lux;
  std::optional<double> sun_lux;
  bool night = false;
  double rig_lamp_cd = 0.0;
  int glare_patches = 0;
  double contrast = 1.0;  ///< factor on that of every material
  Atmosphere atmosphere;
  std::vector<LightStep> light_schedule;  ///< in time order
};

/// A bound on one figure of result.json; `status: ok` is kept apart.
struct Expectation {
  std::string key;
  std::optional<double> min;
  std::optional<double> max;
};

/// Where the sensors sit in the pack unless the scenario says otherwise, x forward, z up [m].
inline const Eigen::Vector3d kDefaultLidarInPack{0.0, 0.0, 0.1};
inline const Eigen::Vector3d kDefaultCameraInPack{0.1, 0.0, 0.0};

/// Cameras on the pack, in their optical frames.
struct MountedCamera {
  Pose pack_from_camera;
  Pose told_camera_from_camera;  ///< error of the mounting: pack_from_camera = (what the estimator is told) * this
  CameraModel model;
  CameraEffects effects;
};
struct MountedDepthCamera {
  Pose pack_from_camera;
  DepthCameraModel model;
  DepthCameraEffects effects;
};

/// A sensor's clock and its messages' way to the estimator; as a scenario says nothing, perfect and without delay.
struct SensorTiming {
  ClockModel clock;
  TransportModel transport;
};

/// The pack of sensors on the vehicle. The pack's origin is the body. The IMU sits there unless its model says
/// otherwise: world_from_body = world_from_vehicle * vehicle_from_pack, point_in_body = pack_from_lidar *
/// point_in_lidar.
struct RigConfig {
  int decimation = 1;    ///< 2 drops every other message of all sensors
  bool own_body = true;  ///< sensors see the vehicle that carries them
  Pose vehicle_from_pack;
  bool has_lidar = true;
  Pose pack_from_lidar;
  LidarModel lidar;
  MountedCamera camera;                            ///< the estimator's: camera 0
  std::optional<double> stereo_baseline_m;         ///< camera 1, the same device to the right of camera 0
  std::optional<MountedDepthCamera> depth_camera;  ///< camera 2
  std::optional<MountedCamera> colour_camera;      ///< colours the map
  ImuModel imu;
  LidarEffects lidar_effects;
  LidarReturns lidar_returns = LidarReturns::kStrongest;
  SensorTiming lidar_timing;
  SensorTiming camera_timing;  ///< of all cameras
  SensorTiming imu_timing;
  Pose told_lidar_from_lidar;  ///< error of the mounting: pack_from_lidar = (what the estimator is told) * this
  bool imu_noise = true;
};

/// One scenario file, composed of the folders' own configs, everything checked.
struct Scenario {
  std::string name;  ///< the file's stem
  std::filesystem::path path;
  std::string digest;         ///< of the resolved keys, for provenance
  std::string resolved_yaml;  ///< all keys after base, file and --set
  std::uint64_t seed = 1;
  WorldConfig world;
  MotionConfig motion;
  RigConfig rig;
  std::vector<Fault> faults;
  std::string estimator_name = "vloam";       ///< of estimator_library(), or an OutsideName
  std::filesystem::path estimator_directory;  ///< in which an outside estimator is started: where its name was set
  EstimatorConfig estimator;
  /// A scenario that is run first, in this one's world: on the map that it leaves this run is localized.
  std::optional<std::filesystem::path> survey;
  std::vector<Expectation> expect;
  std::optional<std::string> expect_status;
};

/// Sixteen hexadecimal digits that tell one text from another, the same over machines and years.
std::string digest_of(const std::string& text);

/// Reads a scenario with its bases and command-line overrides ("key.path=value").
/// @throws InputError for anything missing, malformed, unknown or impossible.
Scenario load_scenario(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                       std::optional<std::uint64_t> seed);

}  // namespace plumbline
