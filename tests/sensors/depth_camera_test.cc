#include "sensors/depth_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

RadianceImage wall(double depth_m) {
  RadianceImage picture;
  picture.width = kWidth;
  picture.height = kHeight;
  picture.depth_m.assign(static_cast<std::size_t>(kWidth) * kHeight, static_cast<float>(depth_m));
  return picture;
}

float& at(std::vector<float>& depth_m, int u, int v) { return depth_m[static_cast<std::size_t>(v * kWidth + u)]; }

DepthCamera camera_with(const DepthCameraEffects& effects) { return {DepthCameraModel{}, effects, 3, "depth"}; }

TEST(DepthCamera, NoiseGrowsWithTheSquareOfDepth) {
  DepthCameraEffects effects;
  effects.quantisation = false;
  const DepthCamera camera = camera_with(effects);
  for (const double depth_m : {0.8, 1.5, 3.0, 4.5}) {
    const DepthFrame frame = camera.measure(wall(depth_m), 0, 2, 0);
    double sum = 0.0;
    double squares = 0.0;
    for (const float d : frame.depth_m) {
      ASSERT_GT(d, 0.0F);
      sum += d - depth_m;
      squares += (d - depth_m) * (d - depth_m);
    }
    const double n = kWidth * kHeight;
    const double sigma = 0.055 / (577.3 * 0.075) * depth_m * depth_m;
    EXPECT_NEAR(std::sqrt(squares / n) / sigma, 1.0, 0.01) << depth_m;
    EXPECT_LT(std::abs(sum / n), 0.02 * sigma) << depth_m;
  }
}

TEST(DepthCamera, DepthComesInStepsOfDisparity) {
  const DepthFrame frame = camera_with({}).measure(wall(3.0), 0, 2, 0);
  const std::set<float> values(frame.depth_m.begin(), frame.depth_m.end());
  EXPECT_LT(values.size(), 8U);
  for (auto next = std::next(values.begin()); next != values.end(); ++next) {
    EXPECT_NEAR(*next - *std::prev(next), 0.125 / 43.3 * 9.0, 0.001);  // 26 mm
  }
}

TEST(DepthCamera, SeesNothingBeyondItsRange) {
  const DepthCamera camera = camera_with({});
  for (const double depth_m : {0.3, 6.0, 200.0}) {
    for (const float d : camera.measure(wall(depth_m), 0, 2, 0).depth_m) ASSERT_EQ(d, 0.0F) << depth_m;
  }
}

TEST(DepthCamera, EdgesAndTheProjectorsShadowHaveNoDepth) {
  DepthCameraEffects effects;
  effects.noise = effects.quantisation = false;
  RadianceImage picture = wall(3.0);
  for (int v = 100; v < 300; ++v) {
    for (int u = 300; u < 400; ++u) at(picture.depth_m, u, v) = 1.0F;
  }
  DepthFrame frame = camera_with(effects).measure(picture, 0, 2, 0);
  EXPECT_NEAR(at(frame.depth_m, 350, 200), 1.0, 1e-4);
  EXPECT_NEAR(at(frame.depth_m, 100, 200), 3.0, 1e-4);
  EXPECT_EQ(at(frame.depth_m, 301, 200), 0.0F);
  EXPECT_EQ(at(frame.depth_m, 401, 200), 0.0F);
  EXPECT_EQ(at(frame.depth_m, 350, 99), 0.0F);
  // The projector is to the right: the shadow, 43.3 (1 - 1/3) = 28.9 px wide, falls to the left.
  EXPECT_EQ(at(frame.depth_m, 275, 200), 0.0F);
  EXPECT_NEAR(at(frame.depth_m, 268, 200), 3.0, 1e-4);
  EXPECT_NEAR(at(frame.depth_m, 405, 200), 3.0, 1e-4);

  effects.shadow = effects.edges = false;
  frame = camera_with(effects).measure(picture, 0, 2, 0);
  for (const float d : frame.depth_m) ASSERT_GT(d, 0.0F);
}

TEST(DepthCamera, TheSameSeedGivesTheSameBytes) {
  const RadianceImage picture = wall(2.0);
  const DepthCamera camera = camera_with({});
  EXPECT_EQ(camera.measure(picture, 0, 2, 5).depth_m, camera_with({}).measure(picture, 0, 2, 5).depth_m);
  EXPECT_NE(camera.measure(picture, 0, 2, 5).depth_m, camera.measure(picture, 0, 2, 6).depth_m);
}

TEST(DepthCamera, RejectsWhatItCannotBe) {
  DepthCameraModel model;
  model.max_range_m = 0.1;
  EXPECT_THROW(DepthCamera(model, {}, 1, "depth"), std::invalid_argument);
  EXPECT_THROW(camera_with({}).measure(RadianceImage{}, 0, 2, 0), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
