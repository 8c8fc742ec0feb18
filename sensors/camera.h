#pragma once

#include <cstdint>
#include <string>

#include "estimator/messages.h"
#include "sim/renderer.h"

namespace plumbline {

/// A global-shutter grey camera: pinhole, auto exposure, shot and read noise in linear light, 8-bit output.
struct CameraModel {
  std::string name = "wide640";
  int width = 640;
  int height = 360;
  double horizontal_fov_deg = 68.0;
  double rate_hz = 50.0;
  double electrons_per_dn = 85.0;  ///< at unit gain; EuRoC MT9V034 as measured
  double read_noise_electrons = 29.0;
  double full_well_electrons = 21600.0;
  double f_number = 2.0;
  double electrons_per_lux_second = 7.36e4;  ///< in a pixel, per lux on the sensor; see camera.cc for the derivation
  double black_level_dn = 5.0;               ///< what darkness reads, so that its noise is not cut off at 0
  double min_exposure_s = 50e-6;
  double max_exposure_s = 8e-3;
  double max_gain = 4.0;     ///< analogue, after the exposure is exhausted
  double target_dn = 100.0;  ///< mean grey value that auto exposure aims at
};

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const CameraModel& model);
CameraIntrinsics intrinsics_of(const CameraModel& model);

/// Turns linear luminance into 8-bit frames. Auto exposure reacts to the previous frame, so frames come in order.
class Camera {
 public:
  /// @param seed  of this camera alone: two cameras with one seed would share their noise
  Camera(CameraModel model, std::uint64_t seed);

  /// Deterministic in (seed, frame_index) and the exposure, which follows from the frames so far.
  /// @throws std::invalid_argument if the image's size is not the model's
  CameraFrame expose(const RadianceImage& image, std::int64_t stamp_ns, std::int64_t frame_index);

  const CameraModel& model() const { return model_; }
  /// Of the next frame.
  double exposure_s() const { return exposure_s_; }
  double gain() const { return gain_; }
  bool noise_enabled = true;

 private:
  void adapt_exposure(double mean_dn);

  CameraModel model_;
  std::uint64_t seed_ = 0;
  double exposure_s_ = 2e-3;
  double gain_ = 1.0;
};

}  // namespace plumbline
