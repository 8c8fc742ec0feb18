#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"
#include "estimator/vision/depth_map.h"
#include "estimator/vision/inverse_depth.h"
#include "estimator/vision/point_frame.h"

namespace plumbline {

/// One set of settings for all scenarios; the reasons stand at the places of use.
struct FrameToFrameConfig {
  bool map_depth_only = false;  ///< only features with depth from the depth map or stereo take part
  int grid_rows = 3;            ///< thesis 3.6: 3 x 5 sub-regions of at most 30 features
  int grid_cols = 5;
  int features_per_cell = 30;
  double depth_max_age_s = 3.0;
  double point_sigma_px = 0.25;   ///< of points given instead of images
  int min_features = 20;          ///< fewer tracks or inliers: the frame is skipped
  double min_inlier_share = 0.4;  ///< fewer: the frame is skipped
  /// On whitened J^T J. Constant velocity foresees the next frame to some 2 cm of a walker at 30 Hz or a car at 10 Hz
  /// (2 m/s^2): what the image knows no better than that, 1 / 0.02^2, is left to it.
  double degeneracy_threshold = 2500.0;
  double refill_share = 0.8;    ///< fewer of the features of the last refill left: new ones are sought
  double refill_pause_s = 0.1;  ///< between looks for corners while there are none to be had
  double restart_s = 0.2;       ///< of skipped frames: the next is compared with the newest again
};

/// Motion from each image to the next with three classes of features, those with depth from a depth map or stereo, with
/// triangulated depth, and without depth (DEMO, thesis ch. 3, Algorithm 1). No IMU: motion goes on at constant
/// velocity.
class FrameToFrame {
 public:
  FrameToFrame(const Calibration& calibration, const FrameToFrameConfig& config,
               WeakDirections weak = WeakDirections::kGuessed);
  FrameToFrame(FrameToFrame&&) noexcept;
  FrameToFrame& operator=(FrameToFrame&&) noexcept;
  ~FrameToFrame();

  struct Step {
    SolveResult solved;   ///< pose: previous_from_body, right perturbations in B now
    Pose predicted;       ///< of the same, at constant velocity
    bool skipped = true;  ///< too few inliers: the motion is the prediction
  };

  /// Tracks, solves, and makes the newest image the one that the next is compared with. The first image starts the
  /// odometry at the origin. Never throws on bad data.
  Step process(const CameraFrame& frame);
  Step process(const PointFrame& frame);

  /// No image shows the motion: it goes on to stamp_ns as it went, and from there at a velocity that something else has
  /// found, [rad/s; m/s] in B.
  void go_on(std::int64_t stamp_ns, const Vector6d& velocity);

  /// De-skewed lidar points, for the images to come. @param odometry_from_body  at their time
  void add_depth_points(std::int64_t stamp_ns, const std::vector<Eigen::Vector3f>& points_in_body,
                        const Pose& odometry_from_body);
  /// A depth image of any camera that the calibration knows.
  void add_depth_image(const DepthFrame& frame);
  /// The second camera's frame of the newest image's moment; others are ignored.
  void add_stereo(const CameraFrame& right);
  void add_stereo(const PointFrame& right);

  /// By an image, or by going on without one.
  bool started() const;
  std::int64_t newest_ns() const;
  /// At the newest image or where it went on to: all steps composed, the body frame at the start being the origin.
  const Pose& odometry_from_body() const;
  /// The same at a later time, at constant velocity.
  Pose predicted(std::int64_t stamp_ns) const;

  /// A feature of the newest image that the last step found to agree with the others.
  struct Sighting {
    std::int64_t id = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the ideal pinhole
    double pixel_sigma = 0.3;
    InverseDepth depth;  ///< kNone: unknown
    DepthSource source = DepthSource::kNone;
  };
  std::vector<Sighting> inliers() const;
  std::vector<TrackedFeature> features() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
