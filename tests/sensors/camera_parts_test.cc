// The parts of a camera, each for itself: auto exposure, photon noise, lens, shutter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sensors/auto_exposure.h"
#include "sensors/lens.h"
#include "sensors/photon_noise.h"
#include "sensors/shutter.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

TEST(AutoExposure, ActsTwoFramesLater) {
  AutoExposure exposure{ExposureControl{}};
  const double start_s = exposure.next().exposure_s;
  exposure.observe(25.0);  // a quarter of the target: twice the exposure, half of the way in stops
  EXPECT_DOUBLE_EQ(exposure.next().exposure_s, start_s);
  exposure.observe(25.0);
  EXPECT_DOUBLE_EQ(exposure.next().exposure_s, 2.0 * start_s);
}

TEST(AutoExposure, IsQuantisedToRowsAndGainSteps) {
  ExposureControl control;
  control.row_time_s = 31.7e-6;
  control.gain_step = 0.0625;
  AutoExposure exposure(control);
  const auto off_step = [](double value, double step) { return std::abs(value / step - std::round(value / step)); };
  for (int i = 0; i < 60; ++i) {
    const ExposureSettings s = exposure.next();
    EXPECT_LT(off_step(s.exposure_s, control.row_time_s), 1e-6);
    EXPECT_LT(off_step(s.gain - 1.0, control.gain_step), 1e-6);
    EXPECT_GE(s.exposure_s, control.min_exposure_s);
    EXPECT_LE(s.exposure_s, control.max_exposure_s);
    EXPECT_LE(s.gain, control.max_gain);
    // A scene that grows dark, then bright; 4e3 DN per second of exposure at first.
    exposure.observe((i < 30 ? 4e3 : 4e5) * s.exposure_s * s.gain);
  }
}

TEST(AutoExposure, SettlesWithinHalfASecondAtFiftyFrames) {
  for (const double dn_per_s : {5e3, 2e4, 1e5, 1e6}) {
    ExposureControl control;
    control.row_time_s = 27.5e-6;
    control.gain_step = 0.0625;
    AutoExposure exposure(control);
    double signal_dn = 0.0;
    for (int i = 0; i < 25; ++i) {
      signal_dn = std::min(dn_per_s * exposure.next().exposure_s * exposure.next().gain, 250.0);
      exposure.observe(signal_dn);
    }
    // A step of the gain, or of the shortest exposures' rows, is up to half the way that the loop still wants to go.
    const double step = std::max(0.0625, 0.5 * 27.5e-6 / exposure.next().exposure_s);
    EXPECT_NEAR(signal_dn / 100.0, 1.0, 0.02 + step) << dn_per_s;
  }
}

TEST(NoiseTables, CountsArePoissons) {
  const NoiseTables tables;
  for (const double mean : {0.05, 0.7, 3.3, 12.9, 49.6, 50.4, 300.0}) {
    constexpr int kDraws = 400000;
    double sum = 0.0;
    double squares = 0.0;
    int zeros = 0;
    for (int i = 0; i < kDraws; ++i) {
      const double n = tables.photons(static_cast<float>(mean), mix_bits(static_cast<std::uint64_t>(i)));
      sum += n;
      squares += n * n;
      zeros += n == 0.0 ? 1 : 0;
    }
    const double found = sum / kDraws;
    // Five standard errors, and 0.3 % of the variance that the tables' ends cut off.
    EXPECT_NEAR(found, mean, 5.0 * std::sqrt(mean / kDraws)) << mean;
    EXPECT_NEAR((squares / kDraws - found * found) / mean, 1.0, 0.003 + 5.0 * std::sqrt((2.0 + 1.0 / mean) / kDraws))
        << mean;
    const double none = std::exp(-mean);
    EXPECT_NEAR(zeros / static_cast<double>(kDraws), none, 5.0 * std::sqrt(none / kDraws) + 2e-4) << mean;
  }
}

TEST(Shutter, OnePictureAPixelAtMostSixteen) {
  EXPECT_EQ(sub_frame_count(0.0), 1);
  EXPECT_EQ(sub_frame_count(0.49), 1);
  EXPECT_EQ(sub_frame_count(2.3), 3);
  EXPECT_EQ(sub_frame_count(100.0), 16);
}

TEST(Shutter, EveryRowGetsItsWholeExposureFromItsOwnTime) {
  for (const Shutter& shutter :
       {Shutter{8e-3, 0.0, 100}, Shutter{4e-3, 30e-6, 100}, Shutter{0.0, 30e-6, 100}, Shutter{1e-4, 30e-6, 100}}) {
    for (const int count : {1, 5, 16}) {
      for (int row = 0; row < shutter.rows; ++row) {
        double sum = 0.0;
        double mean_s = 0.0;
        for (int i = 0; i < count; ++i) {
          const double share = row_share(shutter, row, i, count);
          sum += share;
          mean_s += share * sub_frame_offset_s(shutter, i, count);
        }
        EXPECT_NEAR(sum, 1.0, 1e-6);
        const double row_middle_s = (row - 0.5 * (shutter.rows - 1)) * shutter.row_delay_s;
        // A picture stands for its part of the span.
        EXPECT_NEAR(mean_s, row_middle_s, 0.5 * shutter.span_s() / count + 1e-12);
      }
    }
  }
}

TEST(Lens, ShowsAtEveryPixelWhatLiesOnItsRay) {
  CameraModel model;
  model.distortion = {-0.25, 0.06, 0.001, -0.002};
  const Lens lens(model, {});
  const RenderView& view = lens.view();
  // A picture whose values are the pinhole's x/z and y/z; interpolation of a plane is exact.
  for (const bool horizontal : {true, false}) {
    std::vector<float> picture;
    for (int v = 0; v < view.height; ++v) {
      for (int u = 0; u < view.width; ++u)
        picture.push_back(static_cast<float>(horizontal ? (u - view.cx) / view.fx : (v - view.cy) / view.fy));
    }
    std::vector<float> seen(static_cast<std::size_t>(model.width * model.height), 0.0F);
    lens.add(picture, 1, std::vector<float>(static_cast<std::size_t>(model.height), 1.0F), seen);
    const CameraIntrinsics c = intrinsics_of(model);
    double worst_px = 0.0;
    for (int v = 0; v < c.height; ++v) {
      for (int u = 0; u < c.width; ++u) {
        const Eigen::Vector2d ray = undistort(c.distortion, {(u - c.cx) / c.fx, (v - c.cy) / c.fy});
        const double found = seen[static_cast<std::size_t>(v * c.width + u)];
        worst_px = std::max(worst_px, c.fx * std::abs(found - (horizontal ? ray.x() : ray.y())));
      }
    }
    EXPECT_LT(worst_px, 0.01);
  }
}

TEST(Lens, WithoutDistortionIsTheSensorsOwnPinhole) {
  CameraModel model;
  model.distortion.k1 = -0.25;
  CameraEffects effects;
  effects.distortion = false;
  const Lens lens(model, effects);
  EXPECT_EQ(lens.view().width, model.width);
  EXPECT_EQ(lens.view().height, model.height);
}

}  // namespace
}  // namespace plumbline
