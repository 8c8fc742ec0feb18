#pragma once

#include <optional>
#include <vector>

#include "estimator/messages.h"
#include "estimator/vision/corner_detector.h"
#include "estimator/vision/feature_tracker.h"
#include "estimator/vision/inverse_depth.h"
#include "estimator/vision/motion_constraints.h"
#include "estimator/vision/point_frame.h"

namespace plumbline {

/// Depth of single features from a second camera at the same moment: sought along the epipolar line, refined by the
/// tracker, triangulated over the known baseline. The pair need be neither rectified nor of one kind.
class StereoDepth {
 public:
  StereoDepth(const CameraIntrinsics& left, const Pose& body_from_left, const FurtherCamera& right);

  /// A feature of the left image.
  struct Feature {
    std::int64_t id = 0;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< in the image as it came
    Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();   ///< z = 1
    double pixel_sigma = 0.3;                         ///< [px] of its place, and of that in the right image
    InverseDepth expected;                            ///< where it is sought first, if known
  };

  /// Inverse depths in the left camera, one entry per feature; empty where there is no unambiguous match, all empty
  /// where the right frame is of another size.
  std::vector<std::optional<InverseDepth>> measure(const GreyView& left_image, const CameraFrame& right,
                                                   const std::vector<Feature>& features);
  /// The same where the features' places in the right image are given.
  std::vector<std::optional<InverseDepth>> measure(const PointFrame& right, const std::vector<Feature>& features) const;

 private:
  std::optional<InverseDepth> triangulated(const Feature& feature, const Eigen::Vector2f& right_pixel,
                                           double track_sigma) const;
  std::optional<Eigen::Vector2f> search(const GreyView& left_image, const GreyView& right_image,
                                        const Feature& feature) const;
  std::optional<Eigen::Vector2d> right_pinhole_pixel(const Feature& feature, double inverse_depth) const;

  CameraIntrinsics left_;
  FurtherCamera right_;
  CameraMotion right_from_left_;
  FeatureTracker tracker_;
};

}  // namespace plumbline
