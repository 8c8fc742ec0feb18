#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/input_error.h"
#include "sensors/camera.h"
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
  double light_lux = 200.0;
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

/// The pack of sensors on the vehicle. The pack's origin is the body, where the IMU sits:
/// world_from_body = world_from_vehicle * vehicle_from_pack, point_in_body = pack_from_lidar * point_in_lidar.
struct RigConfig {
  int decimation = 1;    ///< 2 drops every other message of all sensors
  bool own_body = true;  ///< sensors see the vehicle that carries them
  Pose vehicle_from_pack;
  Pose pack_from_lidar;
  Pose pack_from_camera;
  LidarModel lidar;
  CameraModel camera;
  ImuModel imu;
  bool lidar_noise = true;  ///< false: exact, for tests
  bool camera_noise = true;
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
  std::string estimator_name = "vloam";
  EstimatorConfig estimator;
  std::vector<Expectation> expect;
  std::optional<std::string> expect_status;
};

/// Reads a scenario with its bases and command-line overrides ("key.path=value").
/// @throws InputError for anything missing, malformed, unknown or impossible.
Scenario load_scenario(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                       std::optional<std::uint64_t> seed);

}  // namespace plumbline
