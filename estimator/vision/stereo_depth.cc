#include "estimator/vision/stereo_depth.h"

#include <algorithm>
#include <cmath>

#include "estimator/vision/image_patch.h"
#include "estimator/vision/lens_pixels.h"
#include "estimator/vision/triangulation.h"

namespace plumbline {
namespace {

constexpr double kNearest_m = 0.4;
constexpr int kMostSteps = 600;  // [px] along the line: half a metre before a pair 0.54 m apart
constexpr double kLeastStereoCorrelation = 0.8;
/// The next best place along the line, if it is another place, must be clearly worse, or texture repeats itself.
constexpr double kMostOfTheBest = 0.6;  // of what the best leaves to a correlation of one
constexpr int kSamePlace = 4;           // [px]
constexpr double kBaselineRelativeError = 0.002;
constexpr float kStereoBorder = kPatchRadius + 2.0F;

}  // namespace

StereoDepth::StereoDepth(const CameraIntrinsics& left, const Pose& body_from_left, const FurtherCamera& right)
    : left_(left), right_(right) {
  const Pose right_from_left = right.body_from_camera.inverse() * body_from_left;
  right_from_left_.camera_from_keyframe_rotation = right_from_left.rotation.toRotationMatrix();
  right_from_left_.camera_from_keyframe_translation = right_from_left.translation;
}

std::optional<Eigen::Vector2d> StereoDepth::right_pinhole_pixel(const Feature& feature, double inverse_depth) const {
  const Eigen::Vector3d point = right_from_left_.camera_from_keyframe_rotation * feature.ray +
                                inverse_depth * right_from_left_.camera_from_keyframe_translation;
  if (point.z() < 0.05) return std::nullopt;
  return project(right_.intrinsics, point);
}

std::optional<Eigen::Vector2f> StereoDepth::search(const GreyView& left_image, const GreyView& right_image,
                                                   const Feature& feature) const {
  const auto far = right_pinhole_pixel(feature, 0.0);
  const auto near = right_pinhole_pixel(feature, 1.0 / kNearest_m);
  if (!far || !near || !inside(left_image, feature.pixel, kStereoBorder)) return std::nullopt;
  const Patch wanted = read_patch(left_image, feature.pixel);
  const int steps = std::clamp(static_cast<int>((*near - *far).norm()) + 1, 1, kMostSteps);
  const Eigen::Vector2d step = (*near - *far).normalized();
  std::vector<double> scores(static_cast<std::size_t>(steps) + 1, -1.0);
  std::size_t best = 0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Eigen::Vector2f pixel = image_pixel(right_.intrinsics, *far + static_cast<double>(i) * step);
    if (!inside(right_image, pixel, kStereoBorder)) continue;
    scores[i] = correlation(wanted, read_patch(right_image, pixel));
    if (scores[i] > scores[best]) best = i;
  }
  if (scores[best] < kLeastStereoCorrelation) return std::nullopt;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const bool elsewhere = std::max(i, best) - std::min(i, best) > kSamePlace;
    if (elsewhere && 1.0 - scores[best] > kMostOfTheBest * (1.0 - scores[i])) return std::nullopt;
  }
  return image_pixel(right_.intrinsics, *far + static_cast<double>(best) * step);
}

std::vector<std::optional<InverseDepth>> StereoDepth::measure(const GreyView& left_image, const CameraFrame& right,
                                                              const std::vector<Feature>& features) {
  std::vector<std::optional<InverseDepth>> depths(features.size());
  const auto pixels =
      static_cast<std::size_t>(right_.intrinsics.width) * static_cast<std::size_t>(right_.intrinsics.height);
  if (right.width != right_.intrinsics.width || right.height != right_.intrinsics.height ||
      right.pixels.size() != pixels) {
    return depths;
  }
  const GreyView right_image = view_of(right);
  std::vector<std::size_t> sought;
  std::vector<FeatureTracker::Sought> patches;
  for (std::size_t i = 0; i < features.size(); ++i) {
    std::optional<Eigen::Vector2f> place;
    if (features[i].expected.known()) {
      if (const auto pixel = right_pinhole_pixel(features[i], features[i].expected.mean)) {
        place = image_pixel(right_.intrinsics, *pixel);
      }
    } else {
      place = search(left_image, right_image, features[i]);
    }
    if (!place) continue;
    sought.push_back(i);
    patches.push_back({features[i].pixel, *place});
  }
  tracker_.set_image(left_image);
  tracker_.anchor_here();
  tracker_.set_image(right_image);
  const std::vector<FeatureTracker::Track> tracks = tracker_.track(patches);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (tracks[k].found)
      depths[sought[k]] = triangulated(features[sought[k]], tracks[k].pixel, static_cast<double>(tracks[k].sigma_px));
  }
  return depths;
}

std::vector<std::optional<InverseDepth>> StereoDepth::measure(const PointFrame& right,
                                                              const std::vector<Feature>& features) const {
  const std::vector<PointFrame::Point> points = sorted_points(right);
  std::vector<std::optional<InverseDepth>> depths(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const PointFrame::Point* seen = find_point(points, features[i].id);
    if (seen != nullptr) depths[i] = triangulated(features[i], seen->pixel, 0.0);
  }
  return depths;
}

std::optional<InverseDepth> StereoDepth::triangulated(const Feature& feature, const Eigen::Vector2f& right_pixel,
                                                      double track_sigma) const {
  FeatureSighting sighting;
  sighting.keyframe_ray = feature.ray;
  sighting.pixel_sigma = std::hypot(feature.pixel_sigma, track_sigma);
  sighting.pixel = pinhole_pixel(right_.intrinsics, right_pixel);
  const auto depth = triangulate(right_from_left_, right_.intrinsics, sighting, kBaselineRelativeError);
  return depth && depth->known() ? depth : std::nullopt;
}

}  // namespace plumbline
