#include "estimator/vision/rig_watch.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr double kTrackSigma_px = 0.3;  // of a track over a key-frame, its drift included
// A motion that turns the pixel by less says nothing: the gyroscope's own error may be as large.
constexpr double kLeastTurn_px = 0.5;
constexpr double kBound_sigma = 3.0;  // of either error: beyond it, a track gone astray is as likely
constexpr double kEnough = 8.0;       // two reference images in a sharp turn, a second in a motorway's bend

double bounded_square(double error_px) {
  const double in_sigma = std::min(error_px / kTrackSigma_px, kBound_sigma);
  return in_sigma * in_sigma;
}

/// How far a pixel is from where a point of the world may be: from `turned`, where it is if it is infinitely far,
/// towards the side that translation moves it to.
double off_the_line(const Eigen::Vector2d& turned, const Eigen::Vector2d& shift, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d off = pixel - turned;
  const double length = shift.norm();
  if (length <= 0.0) return off.norm();
  const Eigen::Vector2d along = shift / length;
  return (off - std::max(0.0, off.dot(along)) * along).norm();
}

}  // namespace

double evidence_of_riding(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature) {
  const Eigen::Vector3d turned = motion.camera_from_keyframe_rotation * feature.keyframe_ray;
  const Eigen::Vector3d moved = turned + feature.depth.mean * motion.camera_from_keyframe_translation;
  if (turned.z() <= 0.0 || moved.z() <= 0.0) return 0.0;
  const Eigen::Vector2d reference_px = project(camera, feature.keyframe_ray);
  const Eigen::Vector2d turned_px = project(camera, turned);
  if ((turned_px - reference_px).norm() < kLeastTurn_px) return 0.0;
  const Eigen::Vector2d shift_px =
      d_pixel_d_point(camera, turned) * motion.camera_from_keyframe_translation;  // per inverse depth
  const double world_px = feature.depth.known() ? (feature.pixel - project(camera, moved)).norm()
                                                : off_the_line(turned_px, shift_px, feature.pixel);
  const double rig_px = (feature.pixel - reference_px).norm();
  return 0.5 * (bounded_square(world_px) - bounded_square(rig_px));
}

void RidingEvidence::add(double evidence) { sum_ = std::clamp(sum_ + evidence, -kEnough, kEnough); }

bool RidingEvidence::rides() const { return sum_ >= kEnough; }

void RiddenPlaces::add(std::int64_t stamp_ns, const Eigen::Vector2f& image_pixel) {
  stamps_ns_.push_back(stamp_ns);
  pixels_.push_back(image_pixel);
}

void RiddenPlaces::forget_before(std::int64_t stamp_ns) {
  const auto kept = std::lower_bound(stamps_ns_.begin(), stamps_ns_.end(), stamp_ns);
  pixels_.erase(pixels_.begin(), pixels_.begin() + (kept - stamps_ns_.begin()));
  stamps_ns_.erase(stamps_ns_.begin(), kept);
}

}  // namespace plumbline
