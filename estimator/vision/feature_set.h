#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"
#include "estimator/vision/depth_map.h"
#include "estimator/vision/feature_source.h"
#include "estimator/vision/motion_constraints.h"
#include "estimator/vision/rig_watch.h"
#include "estimator/vision/stereo_depth.h"

namespace plumbline {

/// What is unknown about a depthless feature's inverse depth while it has not moved: anything beyond some 3 m.
inline constexpr InverseDepth kFarAway{0.0, 0.3};

/// A feature as a reference image (a key-frame, or simply the image before) and the newest image show it.
struct Feature {
  std::int64_t id = 0;
  FeatureSighting sighting;                         ///< in pixels of the ideal pinhole; the rays are the reference's
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< now, in the image as it came; so are the next two
  Eigen::Vector2f reference_pixel = Eigen::Vector2f::Zero();
  Eigen::Vector2f anchor_pixel = Eigen::Vector2f::Zero();
  double track_sigma = 0.0;                                    ///< [px] of the pixel, from the anchor's
  double anchor_sigma = 0.0;                                   ///< [px] of the anchor's pixel, from the reference's
  Eigen::Matrix2d anchor_shape = Eigen::Matrix2d::Identity();  ///< d pixel d reference pixel when the anchor was taken
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();             ///< of its surface in the reference, as MapDepth::plane
  InverseDepth triangulated;                                   ///< in the reference, from its whole track
  DepthSource depth_source = DepthSource::kNone;
  bool epipolar = false;                                    ///< which row kind this image gives
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  ///< of its reprojection rows, else unused
  bool inlier = true;
  int outlier_frames = 0;  ///< in a row
  RidingEvidence on_rig;
};

struct FeatureSetConfig {
  CornerOptions corners;
  double point_sigma_px = 0.25;  ///< of points that someone else found
  double depth_max_age_s = 3.0;
};

/// The features that a solver of the camera's motion works on: followed from image to image, given depth, made into
/// residual rows. When the reference changes is the solver's affair.
class FeatureSet {
 public:
  FeatureSet(const Calibration& calibration, const FeatureSetConfig& config);

  /// Takes the newest image, or points in place of it. False if it cannot be used.
  template <typename Frame>
  bool take(const Frame& frame) {
    return source_.take(frame);
  }
  /// Moves the features to where the newest image shows them and forgets those that it does not show.
  void track(const Pose& predicted_reference_from_body, const Pose& reference_from_last_body);
  /// The residual rows of all features (thesis 3.8) at a candidate motion.
  void linearize(const Pose& reference_from_body, ResidualRows& rows) const;
  /// Notes inliers and drops features that stay outliers: things that move, wrong depths, tracks gone astray.
  void judge(const std::vector<double>& weights);
  /// Drops features that ride on the rig, and keeps new ones from their places for a while.
  /// @param reference_from_body  at the newest image; its rotation had better not come from these features
  void drop_riders(const Pose& reference_from_body, std::int64_t newest_ns);
  /// Makes the newest image the anchor where scale or roll have changed too much for patches to look alike.
  void renew_anchor(const Pose& reference_from_body);
  /// Makes the newest image the anchor of all patches.
  void anchor_here(const Pose& reference_from_body);

  /// Expresses features and triangulated depths in the newest image, which becomes the reference.
  void make_newest_the_reference(const Pose& reference_from_body);
  /// Finds new features where there are too few; the newest image is the reference. They need an anchor after that.
  void refill();

  /// @param source  kLidar or kDepthImage
  void add_depth_points(std::int64_t stamp_ns, DepthSource source, const std::vector<Eigen::Vector3f>& points_in_body,
                        const Pose& world_from_body);
  /// A depth image of any camera that the calibration knows; images that follow each other closely are left out.
  void add_depth_image(const DepthFrame& frame, const Pose& world_from_body);
  /// The depth map's depth first, then the triangulated, then none (thesis 3.4.3 and 5.2).
  /// @param world_from_body  at the reference, in the world of add_depth_points
  void give_depth(const Pose& world_from_body, std::int64_t reference_ns);
  /// Depth from the second camera's frame of the reference's moment, for features that the depth map does not cover:
  /// a pair's depth grows unsure with its square, the lidar's does not.
  void give_stereo_depth(const CameraFrame& right);
  void give_stereo_depth(const PointFrame& right);

  /// The share of the reference's view that the newest image still shows, from the features' mean shift.
  double overlap() const;
  std::vector<TrackedFeature> shown() const;
  CameraMotion motion(const Pose& reference_from_body) const {
    return camera_motion(reference_from_body, body_from_camera_);
  }
  const CameraIntrinsics& camera() const { return camera_; }
  const Pose& body_from_camera() const { return body_from_camera_; }

  std::vector<Feature> features;

 private:
  std::vector<FeatureSource::Sought> predict(const Pose& predicted_reference_from_body,
                                             const Pose& reference_from_last_body) const;
  bool shows_images() const;
  double sigma_of_any_place() const;
  const FurtherCamera* further_camera(int camera_id) const;
  StereoDepth* stereo_with(int camera_id);
  std::vector<std::size_t> without_map_depth() const;
  std::vector<StereoDepth::Feature> as_seen_by_stereo(const std::vector<std::size_t>& indices) const;
  void take_stereo_depths(const std::vector<std::size_t>& indices,
                          const std::vector<std::optional<InverseDepth>>& depths);

  CameraIntrinsics camera_;
  Pose body_from_camera_;
  std::vector<FurtherCamera> further_cameras_;
  FeatureSetConfig config_;
  FeatureSource source_;
  RiddenPlaces ridden_;
  DepthMap depth_map_;
  std::optional<std::int64_t> depth_image_ns_;  ///< of the last one used
  std::optional<StereoDepth> stereo_;           ///< made when the first frame of a second grey camera comes
};

}  // namespace plumbline
