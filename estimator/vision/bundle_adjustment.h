#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/messages.h"
#include "estimator/vision/frame_to_frame.h"

/// Bundle adjustment over a window of images (thesis 3.5).
namespace plumbline {

struct BundleConfig {
  int image_stride = 5;  ///< thesis: one image in five, eight a window
  int window_images = 8;
  int least_shared_tracks = 20;  ///< of neighbouring images; fewer anywhere: the window stays as it was
};

/// An image as a window holds it: its pose by frame-to-frame motion and its inliers.
struct BundleImage {
  Pose odometry_from_body;
  std::vector<FrameToFrame::Sighting> sightings;
};

/// Refines the images' poses and the features' places; the first image stays. What an image tells of a feature weighs
/// diag(a, a, b): a from the tracking noise; b from the depth's own noise, which for a time-of-flight sensor is
/// constant and for depth that was triangulated (depth camera, stereo, motion) grows with its square, or zero where
/// unknown.
/// @returns first_from_body of every image, or nothing where too few tracks join two images.
std::optional<std::vector<Pose>> adjust_bundle(const std::vector<BundleImage>& images, const Calibration& calibration,
                                               const BundleConfig& config);

}  // namespace plumbline
