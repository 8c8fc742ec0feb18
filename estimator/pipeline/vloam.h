#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/geometry/interpolation.h"
#include "estimator/imu/inertial_filter.h"
#include "estimator/imu/initialization.h"
#include "estimator/lidar/scan_matcher.h"
#include "estimator/lidar/sweep_assembler.h"
#include "estimator/pipeline/increment_watch.h"
#include "estimator/pipeline/lost_watch.h"
#include "estimator/pipeline/message_gate.h"
#include "estimator/vision/visual_odometry.h"

namespace plumbline {

/// How vision and scan matching go together.
enum class Coupling {
  kSequential,  ///< coarse to fine, as the thesis has it
  kJoint        ///< images are tracked only; every scan solves its own rows and the newest image's as one problem
};

/// The whole method on one page (thesis ch. 5): the IMU predicts, vision refines against its key-frame, scan matching
/// refines against the map, each only along the directions that its data determine; both feed back to the IMU.
class Vloam final : public Estimator {
 public:
  Vloam(const Calibration& calibration, const EstimatorConfig& config, Coupling coupling = Coupling::kSequential);

  void add(const ImuSample& sample) override;
  void add(const CameraFrame& frame) override;
  void add(const DepthFrame& frame) override;
  void add(const LidarScan& scan) override;
  /// Points that someone else found and identified, in place of a camera's images.
  void add(const PointFrame& frame);
  std::vector<Odometry> take() override;
  MessageCounts counts(Module module) const override;
  std::vector<TrackedFeature> features() const override;
  std::vector<MapPoint> map() const override;

 private:
  void start_with(const InitialState& start, const ImuSample& sample);
  template <typename Payload>
  void take_in(const Payload& payload);
  void advance_to(std::int64_t stamp_ns, const InertialSegment& segment);
  void handle(const MessageGate::Message& message);
  void handle(const CameraFrame& frame);
  void handle(const PointFrame& frame);
  void handle(const DepthFrame& frame);
  void handle(const LidarScan& scan);
  template <typename Frame>
  void see(const Frame& frame);
  SolveResult match(const FeatureCloud& features, const Pose& map_from_body);
  /// Of the newest solution's covariance, for errors that it shares with those before it.
  double vision_inflation(std::int64_t image_ns);
  void start_keyframe_when_due(std::int64_t image_ns);
  void refine_with_scan(const LidarScan& scan, const DeskewedScan& deskewed);
  void renew_map(const Eigen::Vector3d& step_in_body);
  /// Lets an update act, and moves the recent track with it, so that the track's inner shape stays the IMU's.
  template <typename Update>
  void correct(Update&& update);
  void report(std::int64_t stamp_ns, Module module, const SolveResult& solved, const Pose& predicted, double seconds);
  Odometry output(std::int64_t stamp_ns);

  Calibration calibration_;
  EstimatorConfig config_;
  Coupling coupling_;
  MessageGate gate_;
  Initializer initializer_;
  std::optional<InertialFilter> filter_;  ///< empty until the start is known
  VisualOdometry vision_;
  ScanMatcher matcher_;
  SweepAssembler sweeps_;

  ImuSample last_sample_;
  PoseTrack track_;                                             ///< world_from_body over the last sweep or so
  Eigen::Quaterniond turned_ = Eigen::Quaterniond::Identity();  ///< since the start, by the gyroscope alone
  PoseTrack turn_track_;                                        ///< of turned_
  std::int64_t keyframe_ns_ = 0;
  std::int64_t last_image_ns_ = 0;
  std::optional<std::int64_t> followed_ns_;  ///< stamp of the newest image, while no scan has solved its rows
  double path_m_ = 0.0;
  bool has_map_ = false;
  Eigen::Vector3d last_scan_position_ = Eigen::Vector3d::Zero();

  IncrementWatch increments_;

  LostWatch lost_;
  std::vector<Odometry> outputs_;
  std::vector<ModuleHealth> health_;
};

}  // namespace plumbline
