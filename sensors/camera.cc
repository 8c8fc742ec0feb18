#include "sensors/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

// From luminance to electrons. A lens of f-number N and transmission tau puts H = pi L tau / (4 N^2) lux on the sensor
// (distant object, on the axis). At 555 nm one lux is 1/683 W/m^2 = 4.09e15 photons/(s m^2); a pixel of (6 um)^2 with a
// quantum efficiency of 0.5 makes 4.09e15 * 36e-12 * 0.5 = 7.36e4 electrons/(lux s) of them. The data sheet of the
// MT9V034 (4.8 V/(lux s)), at the 110 uV per electron estimated elsewhere, would give 4.4e4.
constexpr double kLensTransmission = 0.9;

// Auto exposure moves half of the way, in stops, each frame.
constexpr double kExposureDamping = 0.5;

constexpr double kSaturatedDn = 255.0;

double sensor_lux_per_luminance(double f_number) {
  return std::numbers::pi * kLensTransmission / (4.0 * f_number * f_number);
}

/// Quantiles of the standard normal distribution: a uniform index draws from it.
class GaussianTable {
 public:
  static constexpr std::size_t kSize = 8192;

  GaussianTable() {
    // Newton's method from the median outwards; each quantile starts at its neighbour.
    double x = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t i = kSize / 2; i < kSize; ++i) {
      const double probability = (static_cast<double>(i) + 0.5) / kSize;
      for (int iteration = 0; iteration < 8; ++iteration) {
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
        x += (probability - 0.5 * std::erfc(-x / std::numbers::sqrt2)) / density;
      }
      values_[i] = static_cast<float>(x);
      sum_of_squares += 2.0 * x * x;
    }
    const auto scale = static_cast<float>(std::sqrt(kSize / sum_of_squares));
    for (std::size_t i = kSize / 2; i < kSize; ++i) {
      values_[i] *= scale;
      values_[kSize - 1 - i] = -values_[i];
    }
  }

  float draw(std::uint64_t bits) const { return values_[bits & (kSize - 1)]; }

 private:
  std::array<float, kSize> values_;
};

/// One exposure's way from luminance to grey values.
struct Exposure {
  float electrons_per_luminance = 0.0F;
  float full_well = 0.0F;
  float read_variance = 0.0F;
  float dn_per_electron = 0.0F;
  float black_level = 0.0F;

  /// Shot and read noise as one normal draw: where so few electrons come that Poisson's distribution is far from
  /// normal, the read noise, tens of electrons, hides its shape.
  std::uint8_t grey(float luminance, float normal_draw) const {
    const float mean = std::min(luminance * electrons_per_luminance, full_well);
    const float electrons = std::min(mean + normal_draw * std::sqrt(mean + read_variance), full_well);
    const float dn = black_level + electrons * dn_per_electron;
    return static_cast<std::uint8_t>(std::clamp(dn, 0.0F, static_cast<float>(kSaturatedDn)) + 0.5F);
  }
};

}  // namespace

void validate_or_throw(const CameraModel& model) {
  const auto require = [&model](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument("camera " + model.name + ": " + rule);
  };
  require(model.width > 0 && model.height > 0, "width and height must be positive");
  require(model.horizontal_fov_deg > 0.0 && model.horizontal_fov_deg < 180.0,
          "horizontal_fov_deg must be within (0, 180)");
  require(model.rate_hz > 0.0, "rate_hz must be positive");
  require(model.electrons_per_dn > 0.0, "electrons_per_dn must be positive");
  require(model.read_noise_electrons >= 0.0, "read_noise_electrons must not be negative");
  require(model.full_well_electrons > 0.0, "full_well_electrons must be positive");
  require(model.f_number > 0.0, "f_number must be positive");
  require(model.electrons_per_lux_second > 0.0, "electrons_per_lux_second must be positive");
  require(model.black_level_dn >= 0.0 && model.black_level_dn < kSaturatedDn, "black_level_dn must be within [0, 255)");
  require(model.min_exposure_s > 0.0, "min_exposure_s must be positive");
  require(model.max_exposure_s >= model.min_exposure_s, "max_exposure_s must be at least min_exposure_s");
  require(model.max_exposure_s * model.rate_hz <= 1.0, "max_exposure_s must fit into the frame's period");
  require(model.max_gain >= 1.0, "max_gain must be at least 1");
  require(model.target_dn > 0.0 && model.target_dn < kSaturatedDn, "target_dn must be within (0, 255)");
}

CameraIntrinsics intrinsics_of(const CameraModel& model) {
  const double half_fov = 0.5 * model.horizontal_fov_deg * std::numbers::pi / 180.0;
  const double focal_length = 0.5 * model.width / std::tan(half_fov);
  return {model.width, model.height, focal_length, focal_length, 0.5 * (model.width - 1), 0.5 * (model.height - 1)};
}

Camera::Camera(CameraModel model, std::uint64_t seed)
    : model_(std::move(model)), seed_(derive_seed(seed, "camera noise")) {
  validate_or_throw(model_);
  exposure_s_ = std::clamp(exposure_s_, model_.min_exposure_s, model_.max_exposure_s);
}

CameraFrame Camera::expose(const RadianceImage& image, std::int64_t stamp_ns, std::int64_t frame_index) {
  const std::size_t count = static_cast<std::size_t>(model_.width) * static_cast<std::size_t>(model_.height);
  if (image.width != model_.width || image.height != model_.height || image.luminance.size() != count) {
    throw std::invalid_argument("camera " + model_.name + ": the image to expose has another size");
  }
  static const GaussianTable kGaussian;
  const Exposure exposure{
      static_cast<float>(sensor_lux_per_luminance(model_.f_number) * model_.electrons_per_lux_second * exposure_s_),
      static_cast<float>(model_.full_well_electrons),
      static_cast<float>(model_.read_noise_electrons * model_.read_noise_electrons),
      static_cast<float>(gain_ / model_.electrons_per_dn), static_cast<float>(model_.black_level_dn)};

  CameraFrame frame{stamp_ns, 0, model_.width, model_.height, std::vector<std::uint8_t>(count)};
  const std::uint64_t frame_seed = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(frame_index)));
  std::uint64_t sum = 0;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // One hash serves four pixels, 16 bits each.
    bits = i % 4 == 0 ? mix_bits(frame_seed + i) : bits >> 16;
    const float draw = noise_enabled ? kGaussian.draw(bits) : 0.0F;
    frame.pixels[i] = exposure.grey(image.luminance[i], draw);
    sum += frame.pixels[i];
  }
  adapt_exposure(static_cast<double>(sum) / static_cast<double>(count));
  return frame;
}

void Camera::adapt_exposure(double mean_dn) {
  constexpr double kDimmest_dn = 0.5;  // darkness has no ratio to the target
  const double signal = std::max(mean_dn - model_.black_level_dn, kDimmest_dn);
  const double wanted = exposure_s_ * gain_ * std::pow(model_.target_dn / signal, kExposureDamping);
  // Light costs nothing but exposure time; gain comes last.
  exposure_s_ = std::clamp(wanted, model_.min_exposure_s, model_.max_exposure_s);
  gain_ = std::clamp(wanted / exposure_s_, 1.0, model_.max_gain);
}

}  // namespace plumbline
