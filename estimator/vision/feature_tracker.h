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

  struct Tracks {
    std::vector<Eigen::Vector2f> pixels;
    std::vector<char> found;  ///< 0 where the patch was lost: out of the image, no convergence, or unlike its anchor
  };

  /// Copies a new image.
  void set_image(const GreyView& image);
  GreyView image() const;

  /// Makes the newest image the anchor.
  void anchor_here();

  /// Finds in the newest image the patches that the anchor image shows at `anchor_pixels`.
  Tracks track(const std::vector<Eigen::Vector2f>& anchor_pixels, const std::vector<Eigen::Vector2f>& predicted);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
