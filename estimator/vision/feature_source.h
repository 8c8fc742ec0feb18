#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/messages.h"
#include "estimator/vision/corner_detector.h"
#include "estimator/vision/feature_tracker.h"
#include "estimator/vision/point_frame.h"

namespace plumbline {

/// Where features are in the newest image: corners found and tracked in pixels, or points given with identities. The
/// solvers of motion ask this and know no images. A run feeds one kind.
class FeatureSource {
 public:
  FeatureSource(const CameraIntrinsics& camera, const CameraNoise& noise);

  /// A feature to be found again.
  struct Sought {
    std::int64_t id = 0;
    FeatureTracker::Sought patch;  ///< from the image that anchor_here() kept
  };
  static constexpr std::int64_t kNoId = -1;
  /// A feature as the newest image shows it, or (without identity) a place that new ones have to keep away from.
  struct Seen {
    std::int64_t id = kNoId;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  };
  struct Fresh {
    std::int64_t id = 0;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
    double noise_sigma_px = 0.0;  ///< how far image noise alone moves its track
  };

  /// Takes the newest image or points. False, and nothing taken, if it is of another size or not finite.
  bool take(const CameraFrame& frame);
  bool take(const PointFrame& frame);

  std::vector<FeatureTracker::Track> locate(const std::vector<Sought>& sought);
  /// New features away from the present ones.
  std::vector<Fresh> find_new(const std::vector<Seen>& present, const CornerOptions& options);
  /// Makes the newest image the anchor. The present features' anchor pixels are then their newest ones.
  void anchor_here();

  /// The newest image, empty where points are given.
  GreyView image() const;

 private:
  std::vector<FeatureTracker::Track> locate_given(const std::vector<Sought>& sought) const;

  CameraIntrinsics camera_;
  CameraNoise noise_;
  FeatureTracker tracker_;
  std::int64_t next_id_ = 0;
  bool given_ = false;
  std::vector<PointFrame::Point> points_;  ///< given ones, sorted by identity
};

}  // namespace plumbline
