#include "sensors/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

RadianceImage even_image(const CameraModel& model, double luminance) {
  RadianceImage image;
  image.width = model.width;
  image.height = model.height;
  image.luminance.assign(static_cast<std::size_t>(model.width * model.height), static_cast<float>(luminance));
  return image;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

Moments moments_of(const CameraFrame& frame) {
  double sum = 0.0;
  double squares = 0.0;
  for (const std::uint8_t pixel : frame.pixels) {
    sum += pixel;
    squares += static_cast<double>(pixel) * pixel;
  }
  const auto count = static_cast<double>(frame.pixels.size());
  return {sum / count, squares / count - sum * sum / (count * count)};
}

/// The grey value, without black level and at unit gain, that the derivation in camera.cc gives.
double expected_dn(const CameraModel& model, double luminance, double exposure_s) {
  const double lux = std::numbers::pi * luminance * 0.9 / (4.0 * model.f_number * model.f_number);
  return lux * model.electrons_per_lux_second * exposure_s / model.electrons_per_dn;
}

/// A camera whose exposure cannot change.
CameraModel fixed_exposure() {
  CameraModel model;
  model.min_exposure_s = model.max_exposure_s = 2e-3;
  model.max_gain = 1.0;
  return model;
}

TEST(Camera, PhotonTransferFollowsTheCalibrationsNoiseModel) {
  const CameraModel model = fixed_exposure();
  const CameraNoise noise;  // what an estimator is told
  for (const double luminance : {2.0, 10.0, 30.0, 80.0}) {
    // The light covers one grey value evenly: at a single level, rounding to whole values is not independent noise.
    const double level_dn = expected_dn(model, luminance, 2e-3);
    ASSERT_LT(level_dn, 240.0);
    RadianceImage image = even_image(model, luminance);
    const auto dn_of = [&](std::size_t i) { return level_dn + (static_cast<double>(i % 64) + 0.5) / 64.0 - 0.5; };
    for (std::size_t i = 0; i < image.luminance.size(); ++i)
      image.luminance[i] *= static_cast<float>(dn_of(i) / level_dn);

    Camera camera(model, 3);
    const CameraFrame frame = camera.expose(image, 0, 0);
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
      const double error = frame.pixels[i] - model.black_level_dn - dn_of(i);
      sum += error;
      squares += error * error;
    }
    const auto count = static_cast<double>(frame.pixels.size());
    EXPECT_NEAR(sum / count, 0.0, 0.015) << luminance;
    const double variance = noise.read_noise_dn * noise.read_noise_dn + level_dn / noise.electrons_per_dn + 1.0 / 12.0;
    // The variance of 230,400 pixels has a standard error of 0.3 %.
    EXPECT_NEAR(squares / count / variance, 1.0, 0.015) << luminance;
  }
}

TEST(Camera, DarknessIsAmplifiedReadNoise) {
  Camera camera(CameraModel{}, 3);
  const RadianceImage dark = even_image(camera.model(), 0.0);
  CameraFrame frame;
  for (int i = 0; i < 30; ++i) frame = camera.expose(dark, 0, i);
  EXPECT_DOUBLE_EQ(camera.gain(), camera.model().max_gain);
  const Moments grey = moments_of(frame);
  const double sigma = camera.gain() * camera.model().read_noise_electrons / camera.model().electrons_per_dn;
  EXPECT_NEAR(grey.mean, camera.model().black_level_dn, 0.05);
  EXPECT_NEAR(grey.variance, sigma * sigma + 1.0 / 12.0, 0.05 * sigma * sigma);
}

TEST(Camera, NoiseOfNeighboursAndOfFramesIsUncorrelated) {
  const CameraModel model = fixed_exposure();
  Camera camera(model, 3);
  const RadianceImage image = even_image(model, 40.0);
  const CameraFrame first = camera.expose(image, 0, 0);
  const CameraFrame second = camera.expose(image, 0, 1);
  const Moments grey = moments_of(first);
  const auto covariance = [&](const CameraFrame& other, std::size_t shift) {
    double sum = 0.0;
    const std::size_t count = first.pixels.size() - shift;
    for (std::size_t i = 0; i < count; ++i)
      sum += (first.pixels[i] - grey.mean) * (other.pixels[i + shift] - grey.mean);
    return sum / static_cast<double>(count);
  };
  // Five standard errors of the correlation of 230,400 pairs.
  EXPECT_LT(std::abs(covariance(second, 0)), 0.0105 * grey.variance);
  for (const std::size_t shift : {std::size_t{1}, std::size_t{2}, std::size_t{4}, std::size_t{640}}) {
    EXPECT_LT(std::abs(covariance(first, shift)), 0.0105 * grey.variance) << shift;
  }
}

TEST(Camera, AutoExposureReachesItsTargetWithinItsLimits) {
  for (const double luminance : {25.0, 50.0, 1000.0}) {
    Camera camera(CameraModel{}, 3);
    const RadianceImage image = even_image(camera.model(), luminance);
    CameraFrame frame;
    for (int i = 0; i < 25; ++i) frame = camera.expose(image, 0, i);
    EXPECT_NEAR(moments_of(frame).mean - camera.model().black_level_dn, camera.model().target_dn, 1.0) << luminance;
    EXPECT_GE(camera.exposure_s(), camera.model().min_exposure_s);
    EXPECT_LE(camera.exposure_s(), camera.model().max_exposure_s);
    EXPECT_TRUE(camera.gain() == 1.0 || camera.exposure_s() == camera.model().max_exposure_s);
  }
}

TEST(Camera, FullWellLimitsTheGreyValue) {
  const CameraModel model = fixed_exposure();
  Camera camera(model, 3);
  const Moments grey = moments_of(camera.expose(even_image(model, 1e5), 0, 0));
  EXPECT_GT(grey.mean, 254.0);
  EXPECT_LT(grey.variance, 0.1);
}

TEST(Camera, TheSameSeedAndFramesGiveTheSameBytes) {
  Camera a(CameraModel{}, 3);
  Camera b(CameraModel{}, 3);
  Camera other_seed(CameraModel{}, 4);
  const RadianceImage image = even_image(a.model(), 20.0);
  for (int i = 0; i < 3; ++i) {
    const auto pixels = a.expose(image, 0, i).pixels;
    EXPECT_EQ(pixels, b.expose(image, 0, i).pixels);
    EXPECT_NE(pixels, other_seed.expose(image, 0, i).pixels);
  }
}

TEST(Camera, IntrinsicsSpanTheFieldOfView) {
  const CameraIntrinsics intrinsics = intrinsics_of(CameraModel{});
  EXPECT_NEAR(intrinsics.fx, 474.4, 0.1);
  // The image's left edge is half a pixel left of pixel 0's centre.
  const double half_width = (intrinsics.cx + 0.5) / intrinsics.fx;
  EXPECT_NEAR(2.0 * std::atan(half_width) * 180.0 / std::numbers::pi, 68.0, 1e-9);
}

TEST(Camera, RejectsWhatItCannotBe) {
  CameraModel model;
  model.max_gain = 0.5;
  EXPECT_THAT([&] { Camera(model, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("max_gain")));
  model = CameraModel{};
  model.max_exposure_s = 1.0;
  EXPECT_THAT([&] { Camera(model, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("max_exposure_s")));
  Camera camera(CameraModel{}, 1);
  EXPECT_THAT([&] { camera.expose(RadianceImage{}, 0, 0); }, ThrowsMessage<std::invalid_argument>(HasSubstr("size")));
}

}  // namespace
}  // namespace plumbline
