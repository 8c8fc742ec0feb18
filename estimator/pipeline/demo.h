#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/geometry/interpolation.h"
#include "estimator/lidar/scan_matcher.h"
#include "estimator/lidar/sweep_refinement.h"
#include "estimator/pipeline/lost_watch.h"
#include "estimator/pipeline/matched_covariance.h"
#include "estimator/pipeline/message_gate.h"
#include "estimator/pipeline/transform_integration.h"
#include "estimator/vision/bundle_adjustment.h"
#include "estimator/vision/frame_to_frame.h"

namespace plumbline {

/// The stages beyond frame-to-frame motion, and what features it may use.
struct DemoConfig {
  bool bundle_adjustment = true;
  bool map_depth_only = false;    ///< the baseline that leaves features without measured depth unused
  bool scan_matching = false;     ///< refine every scan against the map (thesis ch. 6); where no image shows the
                                  ///< motion, its velocity is then told by the scans
  bool sweep_refinement = false;  ///< before that, against the sweep before; whole sweeps are matched (thesis ch. 7)
  bool constant_prior = false;    ///< in place of remapping, in all stages: the baseline of thesis ch. 7
};

/// DEMO: visual odometry with depth from lidar, depth images or stereo (thesis ch. 3). It needs no IMU; the samples
/// serve as a clock, and the world is level by decree.
class Demo final : public Estimator {
 public:
  Demo(const Calibration& calibration, const EstimatorConfig& config, const DemoConfig& stages);

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
  void handle(const CameraFrame& frame);
  void handle(const PointFrame& frame);
  void handle(const DepthFrame& frame);
  void handle(const LidarScan& scan);
  template <typename Frame>
  void see(const Frame& frame);
  void note(const FrameToFrame::Step& step, std::int64_t previous_ns);
  void adjust_when_due();
  void use_scans(std::int64_t now_ns);
  void go_on_without_images(const LidarScan& scan);
  void use(const LidarScan& scan);
  void refine_with_sweep(const LidarScan& part);
  void match(const FeatureCloud& features, std::int64_t stamp_ns, const Pose& predicted, double seconds);
  Matrix6d covariance_against_map() const;
  Odometry output(std::int64_t stamp_ns);

  Calibration calibration_;
  EstimatorConfig config_;
  DemoConfig stages_;
  BundleConfig bundle_config_;
  MessageGate gate_;
  FrameToFrame vision_;
  SweepRefinement sweeps_;
  ScanMatcher matcher_;
  TransformIntegration integration_;

  PoseTrack odometry_;           ///< odometry_from_body over the last sweep or so
  std::deque<LidarScan> scans_;  ///< waiting for the image that ends their motion
  std::vector<BundleImage> bundle_;
  std::int64_t images_ = 0;     ///< solved so far
  std::int64_t solved_ns_ = 0;  ///< stamp of the last image that was solved
  std::int64_t match_ns_ = 0;   ///< of the last sweep matched
  std::int64_t fixed_ns_ = 0;   ///< of the last image or sweep that determined all directions

  MatchedCovariance covariance_;
  std::int64_t output_ns_ = 0;
  double path_m_ = 0.0;
  Pose world_from_last_match_;

  LostWatch lost_;
  std::vector<Odometry> outputs_;
  std::vector<ModuleHealth> health_;
};

}  // namespace plumbline
