#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "estimator/vision/corner_detector.h"
#include "estimator/vision/feature_set.h"
#include "estimator/vision/patch_alignment.h"
#include "tests/estimator/vision_scene.h"

namespace plumbline {
namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;
using testing::expose;

constexpr float kZoom = 1.08F;  // what a feature set lets pass before it takes a new anchor
const Vector2f kCentre(320.0F, 180.0F);

cv::Mat zoomed(const cv::Mat& image, double zoom, double dx, double dy) {
  const cv::Matx23d affine(zoom, 0, (1.0 - zoom) * kCentre.x() + dx, 0, zoom, (1.0 - zoom) * kCentre.y() + dy);
  cv::Mat warped;
  cv::warpAffine(image, warped, affine, image.size(), cv::INTER_CUBIC);
  return warped;
}

struct Found {
  Vector2f error = Vector2f::Zero();
  float sigma_px = 0.0F;
};

/// Aligns the corners of a texture with those of the same texture zoomed and shifted, from starts half a pixel off.
std::vector<Found> align_zoomed(const Matrix2f& told, double gain, double noise_dn) {
  RandomStream random(3, "patches");
  const cv::Mat texture = testing::random_texture(640, 360, 21);
  const Vector2f shift(0.37F, -0.61F);
  const CameraFrame first = expose(texture, 0, 1.0, noise_dn, random);
  const CameraFrame second = expose(zoomed(texture, kZoom, shift.x(), shift.y()), 1, gain, noise_dn, random);
  std::vector<Found> all;
  for (const Corner& corner : find_corners(view_of(first), 1.0, {}, {})) {
    const Vector2f truth = kCentre + kZoom * (corner.pixel - kCentre) + shift;
    const auto aligned =
        align_patch(view_of(first), corner.pixel, view_of(second), told, truth + Vector2f(0.4F, -0.3F));
    if (aligned) all.push_back({aligned->pixel - truth, aligned->sigma_px});
  }
  return all;
}

double rms(const std::vector<Found>& all) {
  double sum = 0.0;
  for (const Found& f : all) sum += 0.5 * static_cast<double>(f.error.squaredNorm());
  return std::sqrt(sum / static_cast<double>(all.size()));
}

TEST(PatchAlignment, TakesADeformedPatchForWhatItIs) {
  const auto deformed = align_zoomed(kZoom * Matrix2f::Identity(), 1.0, 1.0);
  const auto shifted = align_zoomed(Matrix2f::Identity(), 1.0, 1.0);
  EXPECT_GT(deformed.size(), 200U);
  EXPECT_LT(rms(deformed), 0.02);  // noise of 1 DN over a texture of 35 alone moves a patch by 0.01
  EXPECT_GT(rms(shifted), 4.0 * rms(deformed));
}

TEST(PatchAlignment, IsNotMovedByBrightnessAndContrast) {
  for (const double gain : {0.6, 0.85, 1.15}) {
    EXPECT_LT(rms(align_zoomed(kZoom * Matrix2f::Identity(), gain, 1.0)), 0.03) << gain;
  }
}

TEST(PatchAlignment, KnowsWhatNoiseMakesOfIt) {
  for (const double noise_dn : {2.0, 5.0, 10.0}) {
    const auto all = align_zoomed(kZoom * Matrix2f::Identity(), 1.0, noise_dn);
    double claimed = 0.0;
    for (const Found& f : all) claimed += static_cast<double>(f.sigma_px * f.sigma_px);
    claimed = std::sqrt(claimed / static_cast<double>(all.size()));
    EXPECT_GT(claimed, 0.9 * rms(all)) << noise_dn;
    EXPECT_LT(claimed, 2.0 * rms(all)) << noise_dn;  // it allows for differences that are not noise, too
  }
}

TEST(PatchAlignment, IsUnsureOfAPatchOnTwoSurfaces) {
  RandomStream random(3, "patches");
  const cv::Mat near = testing::random_texture(640, 360, 5);
  const cv::Mat far = testing::random_texture(640, 360, 6);
  const auto view = [&](double shift) {  // the right half moves, and hides the left
    cv::Mat image = far.clone();
    zoomed(near, 1.0, shift, 0.0).colRange(320, 640).copyTo(image.colRange(320, 640));
    return expose(image, 0, 1.0, 1.0, random);
  };
  const CameraFrame first = view(0.0);
  const CameraFrame second = view(1.5);
  const auto sigmas = [&](float x, float moved) {
    std::vector<float> found;
    for (float y = 20.0F; y < 340.0F; y += 10.0F) {
      const auto aligned = align_patch(view_of(first), {x, y}, view_of(second), Matrix2f::Identity(), {x + moved, y});
      if (aligned) found.push_back(aligned->sigma_px);
    }
    return found;
  };
  std::vector<float> inside = sigmas(400.0F, 1.5F);
  std::vector<float> across = sigmas(321.0F, 1.5F);
  std::sort(inside.begin(), inside.end());
  std::sort(across.begin(), across.end());
  EXPECT_GT(across[across.size() / 2], 3.0F * inside[inside.size() / 2]);
}

TEST(PatchAlignment, FindsNothingBesideTheImageOrWithoutACorner) {
  RandomStream random(3, "patches");
  const CameraFrame frame = expose(testing::random_texture(640, 360, 5), 0, 1.0, 1.0, random);
  const CameraFrame plain = expose(cv::Mat(360, 640, CV_8UC1, cv::Scalar(90)), 0, 1.0, 0.0, random);
  const Matrix2f same = Matrix2f::Identity();
  for (const Vector2f& outside : {Vector2f(3, 100), Vector2f(636, 100), Vector2f(100, 2), Vector2f(-50, 1e6F)}) {
    EXPECT_FALSE(align_patch(view_of(frame), outside, view_of(frame), same, {100, 100}));
    EXPECT_FALSE(align_patch(view_of(frame), {100, 100}, view_of(frame), same, outside));
  }
  EXPECT_FALSE(align_patch(view_of(frame), {20, 20}, view_of(frame), 5.0F * same, {20, 20}));
  EXPECT_FALSE(align_patch(view_of(plain), {100, 100}, view_of(frame), same, {100, 100}));
  EXPECT_FALSE(align_patch(view_of(frame), {100, 100}, view_of(plain), same, {100, 100}));
}

/// Contrast that falls to a third over 6 m, as it does towards the rim of an image or where the light falls off.
void fade(testing::TexturedPlane& plane) {
  for (int y = 0; y < plane.texture->rows; ++y) {
    for (int x = 0; x < plane.texture->cols; ++x) {
      auto& grey = plane.texture->at<std::uint8_t>(y, x);
      const double share = std::clamp(std::exp((900.0 - x) * plane.metres_per_texel / 5.5), 0.1, 1.0);
      grey = cv::saturate_cast<std::uint8_t>(110.0 + share * (grey - 110.0));
    }
  }
}

/// Where contrast falls off to one side, a search for shifted patches is drawn to the other by a share of the zoom:
/// some hundredths of a pixel, alike over whole parts of the image, which turned a flight's heading by a degree in
/// 400 m.
TEST(FeatureSet, FollowsASlantingSurfaceWithoutBias) {
  RandomStream random(11, "slant");
  const Calibration calibration = testing::vision_calibration();
  const Eigen::Vector3d along = Eigen::Vector3d(1.0, -1.0, 0.0).normalized();
  auto wall =
      testing::textured_plane(Eigen::Vector3d(10.0, 0.0, 0.0), along, -Eigen::Vector3d::UnitZ(), 30.0, 14.0, 0.01, 8);
  fade(wall);
  const Eigen::Vector3d normal = along.cross(wall.down);

  struct Sum {
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    int count = 0;
  };
  std::array<Sum, 3> thirds;
  for (int trial = 0; trial < 6; ++trial) {
    const Eigen::Vector3d start(0.5 * trial, 0.0, 0.3 * trial - 0.8);
    const auto world_from_body = [&](int k) {
      return Pose{Eigen::Quaterniond::Identity(), start + Eigen::Vector3d(0.25 * k, 0, 0)};
    };
    const auto image = [&](int k) {
      return expose(testing::draw({wall}, calibration, world_from_body(k)), k, 1.0, 1.0, random);
    };
    std::vector<Eigen::Vector3f> points = testing::lidar_points({wall}, world_from_body(0), 0.0, random);
    for (Eigen::Vector3f& p : points) p -= start.cast<float>();
    FeatureSet set(calibration, {});
    ASSERT_TRUE(set.take(image(0)));
    set.add_depth_points(0, DepthSource::kLidar, points, Pose{});
    set.refill();
    set.give_depth(Pose{}, 0);
    set.anchor_here(Pose{});
    Pose reference_from_last;
    for (int k = 1; k <= 8; ++k) {
      const Pose reference_from_body = world_from_body(0).inverse() * world_from_body(k);
      ASSERT_TRUE(set.take(image(k)));
      set.track(reference_from_body, reference_from_last);
      set.renew_anchor(reference_from_body);
      reference_from_last = reference_from_body;
    }
    const Pose world_from_camera = world_from_body(0) * calibration.body_from_camera;
    const Pose camera_from_world = (world_from_body(8) * calibration.body_from_camera).inverse();
    for (const Feature& f : set.features) {
      const Eigen::Vector3d ray = world_from_camera.rotation * f.sighting.keyframe_ray;
      const double depth = normal.dot(wall.origin - world_from_camera.translation) / normal.dot(ray);
      const Eigen::Vector2d truth =
          project(calibration.camera, camera_from_world * (world_from_camera.translation + depth * ray));
      Sum& third = thirds[static_cast<std::size_t>(std::clamp(3.0F * f.reference_pixel.x() / 640.0F, 0.0F, 2.0F))];
      third.error += f.sighting.pixel - truth;
      ++third.count;
    }
  }
  for (const Sum& third : thirds) {
    ASSERT_GT(third.count, 100);
    // The drawing is true to 1/32 px. Shifted patches come to 0.04, 0.11 and 0.04 here.
    EXPECT_LT((third.error / third.count).norm(), 0.03);
  }
}

}  // namespace
}  // namespace plumbline
