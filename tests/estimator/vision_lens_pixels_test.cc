#include "estimator/vision/lens_pixels.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

/// A EuRoC camera: a barrel that moves the corners by some 100 px.
CameraIntrinsics barrel() { return {752, 480, 458.0, 457.0, 367.0, 248.0, {-0.283, 0.074, 0.0002, 0.00002}}; }

TEST(LensPixels, ThereAndBackAgainIsWithinAHundredthOfAPixel) {
  const CameraIntrinsics camera = barrel();
  for (float v = 0.0F; v < 480.0F; v += 7.0F) {
    for (float u = 0.0F; u < 752.0F; u += 7.0F) {
      const Eigen::Vector2f pixel(u, v);
      // Single precision has some 3e-5 px at 752.
      EXPECT_LT((image_pixel(camera, pinhole_pixel(camera, pixel)) - pixel).norm(), 1e-3F) << pixel.transpose();
    }
  }
}

TEST(LensPixels, ABarrelDrawsTheCornersIn) {
  const CameraIntrinsics camera = barrel();
  const Eigen::Vector2d corner = pinhole_pixel(camera, {0.0F, 0.0F});
  EXPECT_LT(corner.x(), -100.0);
  EXPECT_LT(corner.y(), -50.0);
  const PixelBounds bounds = pinhole_bounds(camera);
  EXPECT_LE(bounds.least.x(), corner.x());
  EXPECT_LE(bounds.least.y(), corner.y());
  EXPECT_GT(bounds.most.x(), 852.0);
  EXPECT_GT(bounds.most.y(), 530.0);
}

TEST(LensPixels, ByHand) {
  // x' = x (1 + k1 r^2 + k2 r^4) + 2 p1 x y + p2 (r^2 + 2 x^2) at (0.5, -0.2): r^2 = 0.29.
  const LensDistortion lens{0.1, -0.05, 0.01, 0.02};
  const double radial = 1.0 + 0.1 * 0.29 - 0.05 * 0.29 * 0.29;
  const Eigen::Vector2d distorted = distort(lens, {0.5, -0.2});
  EXPECT_NEAR(distorted.x(), 0.5 * radial - 0.01 * 0.2 + 0.02 * (0.29 + 0.5), 1e-12);
  EXPECT_NEAR(distorted.y(), -0.2 * radial + 0.01 * (0.29 + 0.08) - 0.02 * 0.2, 1e-12);
}

TEST(LensPixels, WithoutDistortionNothingChanges) {
  CameraIntrinsics camera = barrel();
  camera.distortion = {};
  EXPECT_EQ(pinhole_pixel(camera, {13.25F, 400.5F}), Eigen::Vector2d(13.25, 400.5));
  EXPECT_EQ(pinhole_bounds(camera).most, Eigen::Vector2d(752.0, 480.0));
}

}  // namespace
}  // namespace plumbline
