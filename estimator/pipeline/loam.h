#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/geometry/interpolation.h"
#include "estimator/imu/inertial_filter.h"
#include "estimator/imu/initialization.h"
#include "estimator/lidar/scan_matcher.h"
#include "estimator/lidar/steady_motion.h"
#include "estimator/lidar/sweep_assembler.h"
#include "estimator/lidar/sweep_bends.h"
#include "estimator/lidar/sweep_odometry.h"
#include "estimator/pipeline/increment_watch.h"
#include "estimator/pipeline/lost_watch.h"
#include "estimator/pipeline/matched_covariance.h"
#include "estimator/pipeline/message_gate.h"

namespace plumbline {

/// What a lidar pipeline takes from the IMU (thesis 4.6.2).
enum class ImuUse {
  kNone,         ///< its samples are a clock; the motion goes on as it went
  kOrientation,  ///< attitude as the gyro integrates it, its bias left in; only translation is estimated
  kFull          ///< it predicts the motion within the sweep; what it gets wrong there is taken to grow linearly
};

/// Lidar odometry and mapping (thesis ch. 4): odometry within the growing sweep takes out its distortion and gives the
/// motion at the rate of its parts; once a sweep, the whole is matched with the map.
class Loam final : public Estimator {
 public:
  Loam(const Calibration& calibration, const EstimatorConfig& config, ImuUse imu);

  void add(const ImuSample& sample) override;
  void add(const CameraFrame& frame) override { gate_.admit(frame); }
  void add(const DepthFrame& frame) override { gate_.admit(frame); }
  void add(const LidarScan& scan) override;
  std::vector<Odometry> take() override;
  MessageCounts counts(Module module) const override { return gate_.counts(module); }
  std::vector<MapPoint> map() const override { return matcher_.map(); }

 private:
  /// A whole sweep as it came, with its newest return's time.
  struct Sweep {
    LidarScan scan;
    std::int64_t end_ns = 0;
    bool in_parts = false;
  };

  bool started() const { return filter_ || steady_; }
  const NavigationState& state() const { return filter_ ? filter_->state() : steady_->state(); }
  std::optional<InitialState> start_from(const ImuSample& sample);
  void start_with(const InitialState& start);
  void advance_to(std::int64_t stamp_ns, const InertialSegment& segment);
  void handle(const LidarScan& part);
  void follow(const LidarScan& part, std::int64_t now_ns);
  void finish(const Sweep& sweep);
  void redo_first_sweep();
  void match(const FeatureCloud& features, std::int64_t stamp_ns);
  void lay_down(const FeatureCloud& features, std::int64_t stamp_ns);
  PoseTrack bent(const Sweep& sweep, const FeatureCloud& features, const PoseTrack& steady);
  void carry_covariance(std::int64_t end_ns, const Matrix6d& odometry_information);
  void take_motion(std::int64_t now_ns);
  void take_pose(const SolveResult& solved, const Pose& predicted);
  void begin_sweep(FeatureCloud last_sweep, std::int64_t middle_ns, std::int64_t end_ns, const Pose& middle_from_end);
  FeatureCloud features_of(const LidarScan& scan, const PoseTrack& world_from_body, std::int64_t reference_ns) const;
  int effort() const;
  Pose world_from_reference() const;
  Pose predicted_motion(std::int64_t now_ns) const;
  Matrix6d motion_covariance(std::int64_t now_ns) const;
  Matrix6d match_prior() const;
  Matrix6d pose_covariance(std::int64_t stamp_ns) const;
  Matrix6d increment_covariance(double interval_s) const;
  Matrix6d read_turn_covariance(double from_s, double to_s) const;
  Pose correction(std::int64_t stamp_ns) const;
  Pose corrected(const Pose& world_from_body, std::int64_t stamp_ns) const;
  PoseTrack corrected_track() const;
  Odometry output(std::int64_t stamp_ns);

  Calibration calibration_;
  ImuUse imu_;
  bool mapping_;  ///< false: odometry alone, its map as it goes
  bool remapping_;
  MessageGate gate_;
  Initializer initializer_;
  std::optional<InertialFilter> filter_;  ///< with an IMU, from the start on; its key-frame is the last sweep's end
  std::optional<SteadyMotion> steady_;    ///< otherwise
  SweepAssembler assembler_;
  SweepOdometry odometry_;
  ScanMatcher matcher_;
  SweepBends bends_;

  ImuSample last_sample_;
  PoseTrack track_;  ///< world_from_body as predicted since the last sweep's end, and a while before
  std::optional<std::int64_t> growing_;  ///< number of the sweep that grows
  std::optional<Sweep> first_;           ///< while it waits for the second
  std::int64_t last_end_ns_ = 0;         ///< of the sweep before
  Pose reference_from_last_end_;         ///< the reference is B in the middle of the sweep before
  std::int64_t followed_ns_ = 0;         ///< up to where odometry has followed the growing sweep
  SolveResult matched_;                  ///< of the last sweep with the map
  SolveResult motion_;                   ///< its solution there, reference_from_body
  MatchedCovariance covariance_;         ///< without a filter
  std::int64_t start_ns_ = 0;
  std::int64_t newest_ns_ = 0;  ///< of the newest return
  double part_s_ = 0.0;         ///< from one part of a sweep to the next
  IncrementWatch increments_;   ///< with one
  double path_m_ = 0.0;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();

  LostWatch lost_;
  std::vector<Odometry> outputs_;
  std::vector<ModuleHealth> health_;
};

}  // namespace plumbline
