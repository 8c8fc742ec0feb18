#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"
#include "estimator/vision/depth_map.h"
#include "estimator/vision/point_frame.h"

namespace plumbline {

/// One set of settings for all scenarios; the reasons stand at the places of use.
struct VisionConfig {
  int grid_rows = 5;
  int grid_cols = 6;
  int features_per_cell = 10;
  double depth_max_age_s = 3.0;

  double point_sigma_px = 0.25;  ///< of points given instead of images
  int min_features = 20;         ///< fewer tracks or inliers: nothing is solved
  double min_inlier_share = 0.4;
  /// On whitened J^T J. Rows are in units of their own noise, so an eigenvalue is one over a variance: 100 is 0.1 m.
  double degeneracy_threshold = 100.0;

  double keyframe_tracked_share = 0.6;  ///< fewer of the key-frame's features left: a new one
  double keyframe_overlap = 0.7;
  double keyframe_max_age_s = 1.0;
  double keyframe_retry_s = 0.1;  ///< between looks for corners while there are none to be had
};

/// Key-frame visual odometry with depth from lidar, from triangulation, or none (thesis ch. 3 and 5.2): Harris corners,
/// KLT tracks started from the prediction, and one robust 6-DOF problem with the IMU prediction as prior.
///
/// Call order for every image: process(), then start_keyframe() if wants_keyframe().
class VisualOdometry {
 public:
  VisualOdometry(const Calibration& calibration, const VisionConfig& config,
                 WeakDirections weak = WeakDirections::kGuessed);
  VisualOdometry(VisualOdometry&&) noexcept;
  VisualOdometry& operator=(VisualOdometry&&) noexcept;
  ~VisualOdometry();

  /// De-skewed lidar points, for the depth map. @param world_from_body  the estimate at their time
  void add_depth_points(std::int64_t stamp_ns, const std::vector<Eigen::Vector3f>& points_in_body,
                        const Pose& world_from_body);
  /// A depth image of any camera that the calibration knows.
  void add_depth_image(const DepthFrame& frame, const Pose& world_from_body);

  /// The frame of a further grey camera, used if it shows the moment of a key-frame just started: gives depth to the
  /// features that the depth map does not cover.
  void add_stereo(const CameraFrame& right);
  void add_stereo(const PointFrame& right);

  /// Tracks the features into a new image and solves for keyframe_from_body, the body's pose now in the body frame of
  /// the key-frame (right perturbations, in B now).
  /// @param prior  the IMU's prediction of keyframe_from_body, with its covariance
  /// Without a key-frame, with too few usable features, or with an image whose size is not the calibration's, the
  /// result has no well-conditioned direction and the pose is the prior's mean. Never throws on bad data.
  SolveResult process(const CameraFrame& frame, const PosePrior& keyframe_from_body);
  /// The same with given points in place of an image.
  SolveResult process(const PointFrame& frame, const PosePrior& keyframe_from_body);

  /// Tracks the features into a new image and leaves the solving to a problem of several sensors, which takes
  /// linearize() as its rows and ends with settle(). False if the image has nothing to say.
  bool follow(const CameraFrame& frame, const PosePrior& keyframe_from_body);
  bool follow(const PointFrame& frame, const PosePrior& keyframe_from_body);
  /// The newest image's rows at a candidate keyframe_from_body.
  void linearize(const Pose& keyframe_from_body, ResidualRows& rows) const;
  /// @param weights  of the rows' features, in their order
  void settle(const Pose& keyframe_from_body, const std::vector<double>& weights);

  /// True when the newest image should become the key-frame: none yet, too many features lost, or little overlap.
  bool wants_keyframe() const;

  /// Makes the newest image the key-frame: refills features per sub-region and gives them depth. Without a usable
  /// image it does nothing.
  /// @param world_from_body    the estimate at the newest image, in the world of add_depth_points
  /// @param turn_by_gyroscope  last_keyframe_from_body as the gyroscope alone has it: what the camera says of rotation
  ///                           may be the word of features on the rig's own body, which this tells from the world's
  void start_keyframe(const Pose& world_from_body, const Eigen::Quaterniond& turn_by_gyroscope);

  std::vector<TrackedFeature> features() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
