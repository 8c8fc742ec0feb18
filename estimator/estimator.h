#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/messages.h"

namespace plumbline {

enum class Module { kImu, kVision, kLidar, kLocalization };
std::string_view to_string(Module module);

/// What a module did with one message, one row of degeneracy.csv.
enum class ModuleMode {
  kSolved,   ///< all six directions taken from the module's data
  kPartial,  ///< only the well-conditioned directions
  kBypassed  ///< no direction: too few or too poor data; the prediction stands
};
std::string_view to_string(ModuleMode mode);

/// Health of one module's solve. Directions are right perturbations of world_from_body, [rotation; translation] in B.
struct ModuleHealth {
  std::int64_t stamp_ns = 0;
  Module module = Module::kImu;
  ModuleMode mode = ModuleMode::kBypassed;
  Vector6d eigenvalues = Vector6d::Zero();       ///< of the data's J^T J, ascending; rows whitened by sensor noise
  Matrix6d eigenvectors = Matrix6d::Identity();  ///< column i belongs to eigenvalues[i]
  int well_conditioned = 0;                      ///< number of directions above the threshold: the last columns
  int rows = 0;                                  ///< features or correspondences offered
  int inliers = 0;
  Vector6d correction = Vector6d::Zero();  ///< what the module changed of the prediction, in B
  double processing_s = 0.0;
};

/// What came of holding a stack of scans against a prior map.
enum class MapAgreement {
  kAgrees,        ///< it moves the estimate
  kUnconfirmed,   ///< the first of its kind: the next one has to say the same
  kUndetermined,  ///< no direction is well-conditioned
  kOffMap,        ///< too little of what is seen is on the map
  kDisagrees,     ///< what is seen and the map are different shapes
  kTooFar         ///< further from the odometry than it can have drifted
};
std::string_view to_string(MapAgreement agreement);

/// One match with a prior map; its solve's ModuleHealth bears the same stamp.
struct MapMatch {
  std::int64_t stamp_ns = 0;
  MapAgreement agreement = MapAgreement::kUndetermined;
  double overlap = 0.0;  ///< share of what is seen that the map has surfaces near
  double support = 0.0;  ///< share of what the scans tell that the map bears out, in the direction where it is least
  double correction_m = 0.0;  ///< of the prediction
  double correction_rad = 0.0;
  int iterations = 0;
  double processing_s = 0.0;  ///< stacking and matching
};

/// The estimate at one IMU sample's stamp, never revised afterwards.
struct Odometry {
  std::int64_t stamp_ns = 0;
  Pose world_from_body;  ///< z up, starts at the origin with yaw 0
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Matrix6d covariance = Matrix6d::Zero();                ///< of world_from_body, right perturbation
  Matrix6d increment_covariance = Matrix6d::Zero();      ///< of the motion since the previous output
  bool lost = false;                                     ///< the estimator itself no longer believes its pose
  bool localized = false;                                ///< world is a prior map's, and the last matches agree with it
  std::vector<ModuleHealth> health;                      ///< of the messages used since the previous output
  std::vector<MapMatch> map_matches;                     ///< likewise
};

/// A feature of the newest image, for pictures of what vision does.
struct TrackedFeature {
  enum class Depth { kNone, kLidar, kTriangulated };
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();           ///< [px], newest frame
  Eigen::Vector2f keyframe_pixel = Eigen::Vector2f::Zero();  ///< [px], where the key-frame saw it
  Depth depth = Depth::kNone;
  bool inlier = true;
};

struct MapPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< in the estimate's world
  float intensity = 0.0F;
  bool coloured = false;                             ///< a colour camera saw it
  std::array<std::uint8_t, 3> colour{};              ///< red, green, blue, sRGB
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, towards where a surface was seen from; zero: an edge
};

/// Messages taken and refused, per module.
struct MessageCounts {
  std::int64_t used = 0;
  std::map<std::string, std::int64_t> dropped;  ///< reason -> count
};

/// Switches that a scenario or a robot may set; everything else about an estimator is one set of settings for all.
struct EstimatorConfig {
  bool imu_enabled = true;
  bool vision_enabled = true;
  bool lidar_enabled = true;  ///< scan matching; lidar depth for vision stays
  bool remapping = true;      ///< false: the thesis's forced 6-DOF
  /// What less effort costs (thesis ch. 6): the share of its features that vision follows, (0, 1] (Table 6.3), and by
  /// how much scan matching is coarser, at least 1 (Table 6.4).
  double feature_share = 1.0;
  double resolution_factor = 1.0;

  bool operator==(const EstimatorConfig&) const = default;
};

/// An odometry estimator, fed messages in the order in which they arrive. No call throws: a message that cannot
/// be used (not finite, back in time, empty) is counted and dropped. take() gives one Odometry per ImuSample.
class Estimator {
 public:
  virtual ~Estimator() = default;

  virtual void add(const ImuSample& sample) = 0;
  virtual void add(const CameraFrame& frame) = 0;
  virtual void add(const DepthFrame& frame) = 0;
  virtual void add(const LidarScan& scan) = 0;

  /// The outputs since the last call.
  virtual std::vector<Odometry> take() = 0;

  virtual MessageCounts counts(Module module) const = 0;
  virtual std::vector<TrackedFeature> features() const { return {}; }
  /// The map built so far, down-sampled, in a fixed order.
  virtual std::vector<MapPoint> map() const { return {}; }
};

/// The names that make_estimator knows, each with a sentence on what it is.
struct EstimatorInfo {
  std::string name;
  std::string summary;
};
const std::vector<EstimatorInfo>& estimator_library();

/// @throws std::invalid_argument for an unknown name, or a calibration or settings it cannot work with.
std::unique_ptr<Estimator> make_estimator(const std::string& name, const Calibration& calibration,
                                          const EstimatorConfig& config);

/// Writes points as a binary PLY (x, y, z, intensity, normal_x, normal_y, normal_z) through PCL; with red, green and
/// blue if any is coloured, where points that no camera saw are mid grey. @throws std::runtime_error if it cannot be
/// written.
void write_ply(const std::string& path, const std::vector<MapPoint>& points);

}  // namespace plumbline
