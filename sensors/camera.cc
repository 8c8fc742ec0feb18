#include "sensors/camera.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/random_stream.h"

namespace plumbline {

namespace {

constexpr double kUnseenShare = 0.02;  // of the read noise

}  // namespace

// electrons_per_lux_second: at 555 nm one lux is 1/683 W/m^2 = 4.09e15 photons/(s m^2); a pixel of (6 um)^2 with a
// quantum efficiency of 0.5 makes 4.09e15 * 36e-12 * 0.5 = 7.36e4 electrons/(lux s) of them. The data sheet of the
// MT9V034 (4.8 V/(lux s)), at the 110 uV per electron estimated elsewhere, would give 4.4e4.

Camera::Camera(CameraModel model, const CameraEffects& effects, std::uint64_t seed, std::string_view name)
    : model_((validate_or_throw(model), std::move(model))),
      effects_(effects),
      seed_(derive_seed(seed, name)),
      lens_(model_, effects),
      auto_exposure_(model_.exposure) {
  light_.resize(static_cast<std::size_t>(model_.width) * static_cast<std::size_t>(model_.height) *
                (model_.colour ? 3 : 1));
  row_weights_.resize(static_cast<std::size_t>(model_.height));
}

void Camera::begin(int pictures) {
  pictures_ = pictures;
  taken_ = 0;
  std::fill(light_.begin(), light_.end(), 0.0F);
}

void Camera::add(const RadianceImage& picture) {
  const std::vector<float>& values = light_of(picture);
  const int channels = model_.colour ? 3 : 1;
  const RenderView& view = lens_.view();
  const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  if (picture.width != view.width || picture.height != view.height ||
      values.size() != pixels * static_cast<std::size_t>(channels)) {
    throw std::invalid_argument("camera " + model_.name +
                                ": the picture has another size, or not the colours, of the view");
  }
  const Shutter open = shutter();
  for (int row = 0; row < model_.height; ++row) {
    row_weights_[static_cast<std::size_t>(row)] = row_share(open, row, taken_, pictures_);
  }
  lens_.add(values, channels, row_weights_, light_);
  ++taken_;
}

double Camera::electrons_per_lux() const {
  return model_.chip.electrons_per_lux_second * auto_exposure_.next().exposure_s;
}

bool Camera::is_unseen(const RadianceImage& picture) const {
  if (!effects_.read_noise) return false;
  const std::vector<float>& values = light_of(picture);
  const std::vector<float>& lux_per_luminance = lens_.lux_per_luminance();
  const double brightest = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  const double most_lux = brightest * *std::max_element(lux_per_luminance.begin(), lux_per_luminance.end());
  return most_lux * electrons_per_lux() < kUnseenShare * model_.chip.read_noise_electrons;
}

RawImage Camera::read_out(std::int64_t frame_index) {
  const std::vector<float>& lux_per_luminance = lens_.lux_per_luminance();
  const auto electrons_per_lux = static_cast<float>(this->electrons_per_lux());
  const std::size_t channels = light_.size() / lux_per_luminance.size();
  for (std::size_t i = 0; i < lux_per_luminance.size(); ++i) {
    const float electrons_per_luminance = lux_per_luminance[i] * electrons_per_lux;
    for (std::size_t c = 0; c < channels; ++c) light_[i * channels + c] *= electrons_per_luminance;
  }
  const ChipNoise noise{effects_.shot_noise, effects_.dark_current, effects_.read_noise};
  const std::uint64_t frame_seed = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(frame_index)));
  RawImage raw = plumbline::read_out(model_.chip, settings(), noise, light_, model_.width, model_.height, frame_seed);
  auto_exposure_.observe(raw.mean_dn() - model_.chip.black_level_dn);
  return raw;
}

RawImage Camera::expose(const RadianceImage& picture, std::int64_t frame_index) {
  begin(1);
  add(picture);
  return read_out(frame_index);
}

CameraFrame camera_frame(const RawImage& raw, std::int64_t stamp_ns, int camera_id) {
  return {stamp_ns, camera_id, raw.width, raw.height, raw.upper_eight_bits()};
}

}  // namespace plumbline
