#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sensors/camera_model.h"
#include "sensors/lens.h"
#include "sim/renderer.h"

namespace plumbline {

/// Pictures of linear luminance in, frames of the sensor out. A frame's light may come as several pictures, taken at
/// parts of its exposure (see shutter.h): begin(), add() each of them in order, read_out(). Auto exposure reacts to
/// earlier frames, so frames come in order.
class Camera {
 public:
  /// @param seed  the scenario's
  /// @param name  of this camera on its rig: two cameras of one name would share their noise
  /// @throws std::invalid_argument for a model that cannot be
  Camera(CameraModel model, const CameraEffects& effects, std::uint64_t seed, std::string_view name = "camera noise");

  /// What to draw for it.
  const RenderView& view() const { return lens_.view(); }
  /// Of the next frame.
  const ExposureSettings& settings() const { return auto_exposure_.next(); }
  Shutter shutter() const { return shutter_of(model_, effects_, settings().exposure_s); }

  /// Starts a frame of so many pictures.
  void begin(int pictures);
  /// @throws std::invalid_argument if the picture's size is not the view's, or a colour camera's has no colour
  void add(const RadianceImage& picture);
  /// The converter's output. Deterministic in (seed, name, frame_index) and the exposure, which follows from the frames
  /// so far.
  RawImage read_out(std::int64_t frame_index);

  /// Whether a frame of nothing but this picture's light would be lost in the read noise: no pixel would get a
  /// fiftieth of its sigma, of which even 20 x 20 pixels together show less than half a sigma.
  bool is_unseen(const RadianceImage& picture) const;

  /// A frame of one picture.
  RawImage expose(const RadianceImage& picture, std::int64_t frame_index);

  const CameraModel& model() const { return model_; }

 private:
  const std::vector<float>& light_of(const RadianceImage& picture) const {
    return model_.colour ? picture.rgb : picture.luminance;
  }
  double electrons_per_lux() const;

  CameraModel model_;
  CameraEffects effects_;
  std::uint64_t seed_ = 0;
  Lens lens_;
  AutoExposure auto_exposure_;
  int pictures_ = 1;
  int taken_ = 0;
  std::vector<float> light_;  ///< mean luminance [cd/m^2], then electrons, of every pixel and channel
  std::vector<float> row_weights_;
};

/// The 8-bit message of a grey camera.
CameraFrame camera_frame(const RawImage& raw, std::int64_t stamp_ns, int camera_id);

}  // namespace plumbline
