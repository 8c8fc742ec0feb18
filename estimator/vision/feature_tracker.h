#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimator/vision/corner_detector.h"

namespace plumbline {

/// Kanade-Lucas-Tomasi tracking of patches from an anchor image into the newest one. The anchor stays for as long as
/// the patches look alike, so that tracking errors do not add up from frame to frame.
class FeatureTracker {
 public:
  FeatureTracker();
  FeatureTracker(FeatureTracker&&) noexcept;
  FeatureTracker& operator=(FeatureTracker&&) noexcept;
  ~FeatureTracker();

  struct Track {
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
    float sigma_px = 0.0F;  ///< per axis, since the anchor
    bool found = false;     ///< not where the patch was lost: out of the image, no convergence, or unlike its anchor
  };

  /// Copies a new image.
  void set_image(const GreyView& image);
  GreyView image() const;

  /// Makes the newest image the anchor.
  void anchor_here();

  /// A patch to be found again.
  struct Sought {
    Eigen::Vector2f anchor_pixel = Eigen::Vector2f::Zero();
    Eigen::Vector2f predicted = Eigen::Vector2f::Zero();
    Eigen::Matrix2f now_from_anchor = Eigen::Matrix2f::Identity();  ///< how the patch is deformed
  };
  /// Finds in the newest image the patches that the anchor image shows, in their order; nothing without an anchor.
  std::vector<Track> track(const std::vector<Sought>& sought);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
