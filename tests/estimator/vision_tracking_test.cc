#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "estimator/vision/corner_detector.h"
#include "estimator/vision/feature_tracker.h"
#include "tests/estimator/vision_scene.h"

namespace plumbline {
namespace {

using Eigen::Vector2f;
using testing::expose;

CameraFrame noise_frame(double level_dn, double noise_dn, RandomStream& random) {
  return expose(cv::Mat(360, 640, CV_8UC1, cv::Scalar(level_dn)), 0, 1.0, noise_dn, random);
}

/// A texture seen through a window that is shifted by a fraction of a pixel.
cv::Mat shifted(const cv::Mat& texture, double dx, double dy) {
  const cv::Matx23d affine(1, 0, -40.0 + dx, 0, 1, -40.0 + dy);
  cv::Mat image;
  cv::warpAffine(texture, image, affine, cv::Size(640, 360), cv::INTER_CUBIC);
  return image;
}

std::vector<FeatureTracker::Sought> unmoved(const std::vector<Vector2f>& pixels) {
  std::vector<FeatureTracker::Sought> sought;
  for (const Vector2f& p : pixels) sought.push_back({p, p});
  return sought;
}

struct TrackErrors {
  double median_px = 0.0;
  double found_share = 0.0;
};

TrackErrors track_shift(double dx, double dy, double gain, double noise_dn) {
  RandomStream random(7, "shift");
  const cv::Mat texture = testing::random_texture(720, 440, 21);
  const CameraFrame first = expose(shifted(texture, 0, 0), 0, 1.0, noise_dn, random);
  const CameraFrame second = expose(shifted(texture, dx, dy), 1, gain, noise_dn, random);
  const GreyView image = view_of(first);
  std::vector<Vector2f> pixels;
  for (const Corner& c : find_corners(image, image_noise_dn(image, {}), {}, {})) pixels.push_back(c.pixel);
  FeatureTracker tracker;
  tracker.set_image(view_of(first));
  tracker.anchor_here();
  tracker.set_image(view_of(second));
  const auto tracks = tracker.track(unmoved(pixels));
  std::vector<double> errors;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vector2f moved = pixels[i] + Vector2f(static_cast<float>(dx), static_cast<float>(dy));
    if (tracks[i].found) errors.push_back((tracks[i].pixel - moved).norm());
  }
  if (errors.empty()) return {1e9, 0.0};
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return {errors[errors.size() / 2], static_cast<double>(errors.size()) / static_cast<double>(pixels.size())};
}

TEST(ImageNoise, IsMeasuredWithinATenthOnPlainImages) {
  RandomStream random(1, "noise");
  for (const double sigma : {1.0, 3.0, 8.0}) {
    const CameraFrame frame = noise_frame(100.0, sigma, random);
    EXPECT_NEAR(image_noise_dn(view_of(frame), {}), std::hypot(sigma, std::sqrt(1.0 / 12.0)), 0.1 * sigma + 0.1);
  }
}

TEST(ImageNoise, IsNotMistakenForTexture) {
  RandomStream random(1, "noise");
  const CameraFrame frame = expose(testing::random_texture(640, 360, 4), 0, 1.0, 1.0, random);
  EXPECT_LT(image_noise_dn(view_of(frame), {}), 3.0);  // the texture's own deviation is 35
}

TEST(Corners, FillEverySubRegionOfATexturedImageToItsShareAndKeepApart) {
  RandomStream random(1, "noise");
  const CameraFrame frame = expose(testing::random_texture(640, 360, 4), 0, 1.0, 1.0, random);
  const auto corners = find_corners(view_of(frame), 1.0, {}, {});
  EXPECT_EQ(corners.size(), 300U);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_LT(corners[i].noise_sigma_px, 0.25);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((corners[i].pixel - corners[j].pixel).lpNorm<Eigen::Infinity>(), 8.0F);
    }
  }
}

TEST(Corners, OfAShareThereIsAtLeastOneACell) {
  EXPECT_EQ(features_of_share(10, 1.0), 10);
  EXPECT_EQ(features_of_share(10, 0.5), 5);
  EXPECT_EQ(features_of_share(10, 0.01), 1);
}

TEST(Corners, RefillOnlyWhereFeaturesAreMissing) {
  RandomStream random(1, "noise");
  const CameraFrame frame = expose(testing::random_texture(640, 360, 4), 0, 1.0, 1.0, random);
  std::vector<Vector2f> held;
  for (const Corner& c : find_corners(view_of(frame), 1.0, {}, {})) {
    if (c.pixel.x() > 320.0F) held.push_back(c.pixel);
  }
  for (const Corner& c : find_corners(view_of(frame), 1.0, held, {})) EXPECT_LT(c.pixel.x(), 330.0F);
}

TEST(Corners, AreNotFoundInNoiseHoweverStrongOrDark) {
  RandomStream random(2, "dark");
  for (const double level : {0.0, 2.0, 20.0}) {
    for (const double sigma : {0.3, 0.7, 1.4, 3.0, 8.0}) {
      for (int i = 0; i < 10; ++i) {
        const CameraFrame frame = noise_frame(level, sigma, random);
        EXPECT_TRUE(find_corners(view_of(frame), image_noise_dn(view_of(frame), {}), {}, {}).empty())
            << "level " << level << " noise " << sigma;
      }
    }
  }
}

TEST(FeatureTracker, FollowsShiftsAsLargeAsAPredictionErrsToSubPixel) {
  for (const auto& [dx, dy] : {std::pair{0.37, -0.61}, std::pair{6.2, 3.8}, std::pair{-8.5, 5.1}}) {
    const TrackErrors errors = track_shift(dx, dy, 1.0, 1.0);
    EXPECT_LT(errors.median_px, 0.07) << dx << ", " << dy;
    EXPECT_GT(errors.found_share, 0.8) << dx << ", " << dy;  // the rest left the image or its margin
  }
}

TEST(FeatureTracker, IsNotMovedByAChangeOfExposure) {
  for (const double gain : {0.6, 0.85, 1.15}) {
    const TrackErrors errors = track_shift(2.4, -1.3, gain, 1.0);
    EXPECT_LT(errors.median_px, 0.06) << gain;
    EXPECT_GT(errors.found_share, 0.9) << gain;
  }
}

TEST(FeatureTracker, LosesEverythingWhenTheLightGoesOut) {
  RandomStream random(7, "shift");
  const CameraFrame lit = expose(testing::random_texture(640, 360, 21), 0, 1.0, 1.0, random);
  const GreyView image = view_of(lit);
  std::vector<Vector2f> pixels;
  for (const Corner& c : find_corners(image, image_noise_dn(image, {}), {}, {})) pixels.push_back(c.pixel);
  FeatureTracker tracker;
  tracker.set_image(view_of(lit));
  tracker.anchor_here();
  tracker.set_image(view_of(noise_frame(0.0, 1.4, random)));
  const auto tracks = tracker.track(unmoved(pixels));
  // Chance correlations above 0.7 over 121 pixels, after a search that maximises them, stay rare.
  EXPECT_LT(std::count_if(tracks.begin(), tracks.end(), [](const auto& track) { return track.found; }), 10);
}

TEST(FeatureTracker, WithoutAnAnchorFindsNothing) {
  RandomStream random(1, "noise");
  FeatureTracker tracker;
  tracker.set_image(view_of(noise_frame(50.0, 1.0, random)));
  EXPECT_TRUE(tracker.track(unmoved({Vector2f(100, 100)})).empty());
}

}  // namespace
}  // namespace plumbline
