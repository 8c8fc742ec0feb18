#include "estimator/vision/stereo_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core/mat.hpp>

#include "estimator/vision/depth_image.h"
#include "tests/estimator/vision_scene.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;
using testing::textured_plane;
using testing::TexturedPlane;

constexpr double kBaseline_m = 0.2;

struct Pair {
  Calibration calibration = testing::vision_calibration();
  FurtherCamera right;
  CameraFrame left_frame;
  CameraFrame right_frame;
};

/// A wall at 8 m and a board at 3 m before it, from two cameras that differ in brightness.
Pair pair_of(const std::vector<TexturedPlane>& planes) {
  Pair pair;
  RandomStream random(3, "pair");
  Pose body_from_right = pair.calibration.body_from_camera;
  body_from_right.translation += body_from_right.rotation * Vector3d(kBaseline_m, 0.0, 0.0);
  pair.right = {1, body_from_right, pair.calibration.camera, 30.0};
  pair.left_frame = testing::expose(testing::draw(planes, pair.calibration, Pose{}), 0, 1.0, 1.0, random);
  Calibration seen_from_right = pair.calibration;
  seen_from_right.body_from_camera = body_from_right;
  pair.right_frame = testing::expose(testing::draw(planes, seen_from_right, Pose{}), 0, 0.9, 1.0, random);
  return pair;
}

std::vector<StereoDepth::Feature> corners_of(const Pair& pair) {
  std::vector<StereoDepth::Feature> features;
  const GreyView image = view_of(pair.left_frame);
  for (const Corner& corner : find_corners(image, image_noise_dn(image, {}), {}, {})) {
    features.push_back({static_cast<std::int64_t>(features.size()),
                        corner.pixel,
                        ray_through(pair.calibration.camera, corner.pixel.cast<double>()),
                        0.3,
                        {}});
  }
  return features;
}

TEST(StereoDepth, FindsTheDepthOfCornersWithoutAFirstGuess) {
  const std::vector<TexturedPlane> planes{textured_plane({8, 0, 0}, {0, -1, 0}, {0, 0, -1}, 24, 14, 0.012, 1),
                                          textured_plane({3, 0.3, 0}, {0, -1, 0}, {0, 0, -1}, 1.2, 1.2, 0.005, 2)};
  const Pair pair = pair_of(planes);
  StereoDepth stereo(pair.calibration.camera, pair.calibration.body_from_camera, pair.right);
  const auto features = corners_of(pair);
  const auto depths = stereo.measure(view_of(pair.left_frame), pair.right_frame, features);
  ASSERT_EQ(depths.size(), features.size());
  int found = 0;
  int wrong = 0;
  int near = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!depths[i]) continue;
    ++found;
    const Vector3d in_body = pair.calibration.body_from_camera * (features[i].ray / depths[i]->mean);
    const double off = std::min(std::abs(in_body.x() - 8.0), std::abs(in_body.x() - 3.0));
    near += std::abs(in_body.x() - 3.0) < 0.2 ? 1 : 0;
    // At 8 m a disparity of 12 px: a quarter of a pixel is 2 %, or 0.17 m.
    wrong += off > 4.0 * std::max(0.02, depths[i]->sigma / (depths[i]->mean * depths[i]->mean)) ? 1 : 0;
  }
  EXPECT_GT(found, static_cast<int>(features.size()) / 2);
  EXPECT_GT(near, 3);
  EXPECT_LE(wrong, found / 20);  // corners at the board's edge show both surfaces
}

TEST(StereoDepth, AnotherSizeOrAnEmptyFrameGivesNothing) {
  const Pair pair = pair_of({textured_plane({8, 0, 0}, {0, -1, 0}, {0, 0, -1}, 24, 14, 0.012, 1)});
  StereoDepth stereo(pair.calibration.camera, pair.calibration.body_from_camera, pair.right);
  const auto features = corners_of(pair);
  for (const CameraFrame& frame : {CameraFrame{}, CameraFrame{0, 1, 320, 180, std::vector<std::uint8_t>(320 * 180)}}) {
    for (const auto& depth : stereo.measure(view_of(pair.left_frame), frame, features)) EXPECT_FALSE(depth.has_value());
  }
}

TEST(DepthImage, GivesThePointsOfItsSurfacesAndNoneAtJumps) {
  const CameraIntrinsics camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  DepthFrame frame{0, 2, 64, 48, std::vector<float>(64 * 48, 4.0F)};
  for (int v = 0; v < 48; ++v) {
    for (int u = 32; u < 64; ++u) frame.depth_m[static_cast<std::size_t>(64 * v + u)] = 2.0F;
  }
  frame.depth_m[0] = std::numeric_limits<float>::quiet_NaN();
  const auto points = depth_image_points(frame, camera, 0.1);  // less than a pixel: all of them
  for (const Eigen::Vector3f& p : points) {
    EXPECT_TRUE(p.z() == 4.0F || p.z() == 2.0F);
    EXPECT_NEAR(p.x() / p.z() > 0.0F ? 2.0F : 4.0F, p.z(), 1e-6);
    const float column = p.x() / p.z() * 60.0F + 31.5F;
    EXPECT_GT(std::abs(column - 31.5F), 0.9F) << "beside the jump";
  }
  EXPECT_EQ(points.size(), 60u * 46u);
}

}  // namespace
}  // namespace plumbline
