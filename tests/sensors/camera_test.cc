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

CameraEffects even_light() {
  CameraEffects effects;
  effects.vignetting = false;
  return effects;
}

RadianceImage even_image(const RenderView& view, double luminance) {
  RadianceImage image;
  image.width = view.width;
  image.height = view.height;
  image.luminance.assign(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height),
                         static_cast<float>(luminance));
  return image;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// Of an even image, in 8-bit counts but of all ten bits.
Moments moments_of(const RawImage& raw) {
  double sum = 0.0;
  double squares = 0.0;
  for (const std::uint16_t count : raw.counts) {
    sum += 0.25 * count;
    squares += 0.0625 * count * count;
  }
  const auto n = static_cast<double>(raw.counts.size());
  return {sum / n, squares / n - sum * sum / (n * n)};
}

/// A camera whose exposure cannot change.
CameraModel fixed_exposure() {
  CameraModel model;
  model.exposure.min_exposure_s = model.exposure.max_exposure_s = 2e-3;
  model.exposure.max_gain = 1.0;
  return model;
}

TEST(Camera, LuminanceBecomesGreyAsTheLensAndTheChipSay) {
  const CameraModel model = fixed_exposure();
  Camera camera(model, even_light(), 3);
  const double luminance = 40.0;
  const double lux = std::numbers::pi * luminance * 0.9 / (4.0 * model.f_number * model.f_number);
  const double electrons = lux * model.chip.electrons_per_lux_second * 2e-3;
  const double dn = electrons / model.chip.electrons_per_dn;
  const Moments grey = moments_of(camera.expose(even_image(camera.view(), luminance), 0));
  // The mean of 230,400 pixels of 0.6 DN noise.
  EXPECT_NEAR(grey.mean, model.chip.black_level_dn + dn, 0.01);
  const double read_dn = model.chip.read_noise_electrons / model.chip.electrons_per_dn;
  const double variance = dn / model.chip.electrons_per_dn + read_dn * read_dn + 0.0625 / 12.0;
  EXPECT_NEAR(grey.variance / variance, 1.0, 0.015);
}

TEST(Camera, CornersGetTheFourthPowerOfTheCosine) {
  CameraEffects effects;
  effects.shot_noise = effects.read_noise = false;
  CameraModel model = fixed_exposure();
  model.chip.dark_current_electrons_per_s = 0.0;
  Camera camera(model, effects, 3);
  const RawImage raw = camera.expose(even_image(camera.view(), 40.0), 0);
  const double pedestal = 4.0 * camera.model().chip.black_level_dn;
  const auto at = [&](int u, int v) { return raw.counts[static_cast<std::size_t>(v * raw.width + u)] - pedestal; };
  const double f = camera.view().fx;
  const double cosine = f / std::sqrt(f * f + 319.5 * 319.5 + 179.5 * 179.5);
  EXPECT_NEAR(at(0, 0) / at(320, 180), std::pow(cosine, 4), 0.01);  // rounded to 200 of 400 counts
}

TEST(Camera, DarknessIsAmplifiedReadNoise) {
  Camera camera(CameraModel{}, {}, 3);
  const RadianceImage dark = even_image(camera.view(), 0.0);
  RawImage raw;
  for (int i = 0; i < 30; ++i) raw = camera.expose(dark, i);
  const SensorChip& chip = camera.model().chip;
  EXPECT_DOUBLE_EQ(camera.settings().gain, camera.model().exposure.max_gain);
  EXPECT_DOUBLE_EQ(camera.settings().exposure_s, camera.model().exposure.max_exposure_s);
  const Moments grey = moments_of(raw);
  const double sigma = camera.settings().gain * chip.read_noise_electrons / chip.electrons_per_dn;
  EXPECT_NEAR(grey.mean, chip.black_level_dn, 0.02);
  EXPECT_NEAR(grey.variance, sigma * sigma + 0.0625 / 12.0, 0.02 * sigma * sigma);
}

TEST(Camera, LightIsUnseenThatAddsLessThanAFiftiethOfTheReadNoise) {
  const CameraModel model = fixed_exposure();
  Camera camera(model, even_light(), 3);
  const double lux = Lens(model, even_light()).lux_per_luminance().front();  // of 1 cd/m^2
  const double electrons = lux * model.chip.electrons_per_lux_second * camera.settings().exposure_s;
  const double limit = 0.02 * model.chip.read_noise_electrons / electrons;
  RadianceImage picture = even_image(camera.view(), 0.0);
  EXPECT_TRUE(camera.is_unseen(picture));
  picture.luminance[1234] = static_cast<float>(0.9 * limit);
  EXPECT_TRUE(camera.is_unseen(picture));
  picture.luminance[1234] = static_cast<float>(1.1 * limit);  // a single pixel is enough
  EXPECT_FALSE(camera.is_unseen(picture));
  CameraEffects noiseless = even_light();
  noiseless.read_noise = false;
  EXPECT_FALSE(Camera(model, noiseless, 3).is_unseen(even_image(camera.view(), 0.0)));
}

TEST(Camera, DarkCurrentAddsElectronsAndTheirNoise) {
  CameraModel model = fixed_exposure();
  model.chip.dark_current_electrons_per_s = 5e5;  // 1000 electrons in 2 ms
  Camera camera(model, {}, 3);
  const Moments grey = moments_of(camera.expose(even_image(camera.view(), 0.0), 0));
  const double per_dn = model.chip.electrons_per_dn;
  EXPECT_NEAR(grey.mean - model.chip.black_level_dn, 1000.0 / per_dn, 0.01);
  EXPECT_NEAR(grey.variance, (1000.0 + 29.0 * 29.0) / (per_dn * per_dn) + 0.0625 / 12.0, 0.01);
}

TEST(Camera, NoiseOfNeighboursAndOfFramesIsUncorrelated) {
  Camera camera(fixed_exposure(), even_light(), 3);
  const RadianceImage image = even_image(camera.view(), 40.0);
  const RawImage first = camera.expose(image, 0);
  const RawImage second = camera.expose(image, 1);
  const Moments grey = moments_of(first);
  const auto correlation = [&](const RawImage& other, std::size_t shift) {
    double sum = 0.0;
    const std::size_t count = first.counts.size() - shift;
    for (std::size_t i = 0; i < count; ++i)
      sum += (0.25 * first.counts[i] - grey.mean) * (0.25 * other.counts[i + shift] - grey.mean);
    return sum / static_cast<double>(count) / grey.variance;
  };
  // Five standard errors of the correlation of 230,400 pairs.
  EXPECT_LT(std::abs(correlation(second, 0)), 0.0105);
  for (const std::size_t shift : {std::size_t{1}, std::size_t{2}, std::size_t{4}, std::size_t{640}}) {
    EXPECT_LT(std::abs(correlation(first, shift)), 0.0105) << shift;
  }
}

TEST(Camera, AutoExposureReachesItsTargetWithinItsLimits) {
  for (const double luminance : {25.0, 50.0, 1000.0}) {
    Camera camera(CameraModel{}, even_light(), 3);
    const RadianceImage image = even_image(camera.view(), luminance);
    RawImage raw;
    for (int i = 0; i < 40; ++i) raw = camera.expose(image, i);
    const ExposureControl& control = camera.model().exposure;
    EXPECT_NEAR(moments_of(raw).mean - camera.model().chip.black_level_dn, control.target_dn, 1.0) << luminance;
    const ExposureSettings settings = camera.settings();
    EXPECT_GE(settings.exposure_s, control.min_exposure_s);
    EXPECT_LE(settings.exposure_s, control.max_exposure_s);
    EXPECT_TRUE(settings.gain == 1.0 || settings.exposure_s == control.max_exposure_s);
  }
}

TEST(Camera, FullWellLimitsTheGreyValue) {
  CameraModel model = fixed_exposure();
  model.chip.full_well_electrons = 10000.0;
  Camera camera(model, {}, 3);
  const Moments grey = moments_of(camera.expose(even_image(camera.view(), 1e5), 0));
  EXPECT_NEAR(grey.mean, model.chip.black_level_dn + 10000.0 / model.chip.electrons_per_dn, 0.01);
  EXPECT_NEAR(grey.variance, 29.0 * 29.0 / 85.0 / 85.0 + 0.0625 / 12.0, 0.01);
}

TEST(Camera, NoiseCanBeSwitchedOff) {
  CameraEffects effects = even_light();
  effects.shot_noise = effects.dark_current = effects.read_noise = false;
  Camera camera(fixed_exposure(), effects, 3);
  EXPECT_EQ(moments_of(camera.expose(even_image(camera.view(), 40.0), 0)).variance, 0.0);
}

TEST(Camera, TheSameSeedAndFramesGiveTheSameBytes) {
  Camera a(CameraModel{}, {}, 3);
  Camera b(CameraModel{}, {}, 3);
  Camera other_seed(CameraModel{}, {}, 4);
  Camera other_name(CameraModel{}, {}, 3, "right");
  const RadianceImage image = even_image(a.view(), 20.0);
  for (int i = 0; i < 3; ++i) {
    const auto counts = a.expose(image, i).counts;
    EXPECT_EQ(counts, b.expose(image, i).counts);
    EXPECT_NE(counts, other_seed.expose(image, i).counts);
    EXPECT_NE(counts, other_name.expose(image, i).counts);
  }
}

TEST(Camera, AColourCameraKeepsTheChannelsApart) {
  CameraModel model = fixed_exposure();
  model.colour = true;
  model.width = 32;
  model.height = 16;
  CameraEffects effects = even_light();
  effects.shot_noise = effects.dark_current = effects.read_noise = false;
  Camera camera(model, effects, 3);
  RadianceImage image = even_image(camera.view(), 20.0);
  EXPECT_THROW(camera.expose(image, 0), std::invalid_argument);  // grey
  for (std::size_t i = 0; i < image.luminance.size(); ++i) image.rgb.insert(image.rgb.end(), {80.0F, 40.0F, 20.0F});
  const RawImage raw = camera.expose(image, 0);
  ASSERT_EQ(raw.channels, 3);
  const double pedestal = 4.0 * model.chip.black_level_dn;
  EXPECT_NEAR((raw.counts[0] - pedestal) / (raw.counts[1] - pedestal), 2.0, 0.05);
  EXPECT_NEAR((raw.counts[1] - pedestal) / (raw.counts[2] - pedestal), 2.0, 0.1);
}

TEST(Camera, TheMessageHasTheUpperEightBits) {
  RawImage raw;
  raw.width = 4;
  raw.height = 1;
  raw.counts = {0, 3, 402, 1023};
  const CameraFrame frame = camera_frame(raw, 7, 1);
  EXPECT_EQ(frame.stamp_ns, 7);
  EXPECT_EQ(frame.camera_id, 1);
  EXPECT_THAT(frame.pixels, ::testing::ElementsAre(0, 0, 100, 255));
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
  model.exposure.max_gain = 0.5;
  EXPECT_THAT([&] { Camera(model, {}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("max_gain")));
  model = CameraModel{};
  model.exposure.max_exposure_s = 1.0;
  EXPECT_THAT([&] { Camera(model, {}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("max_exposure_s")));
  model = CameraModel{};
  model.distortion.k1 = -2.0;
  EXPECT_THAT([&] { Camera(model, {}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("distortion")));
  model = CameraModel{};
  model.rolling_shutter = true;
  EXPECT_THAT([&] { Camera(model, {}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("row_time_s")));
  Camera camera(CameraModel{}, {}, 1);
  EXPECT_THAT([&] { camera.expose(RadianceImage{}, 0); }, ThrowsMessage<std::invalid_argument>(HasSubstr("size")));
}

}  // namespace
}  // namespace plumbline
