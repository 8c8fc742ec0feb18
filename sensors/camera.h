#pragma once

#include <cstdint>
#include <string>

#include "estimator/messages.h"
#include "sim/random_stream.h"
#include "sim/renderer.h"

namespace plumbline {

/// A global-shutter grey camera: pinhole, auto exposure, shot and read noise in linear light, 8-bit output.
struct CameraModel {
  std::string name = "wide640";
  int width = 640;
  int height = 360;
  double horizontal_fov_deg = 68.0;
  double rate_hz = 50.0;
  double electrons_per_dn = 85.0;          ///< at unit gain; EuRoC MT9V034 as measured
  double read_noise_electrons = 29.0;
  double full_well_electrons = 21600.0;
  double electrons_per_lux_second = 0.0;   ///< of scene luminance -> electrons; see camera.cc for the derivation
  double min_exposure_s = 50e-6;
  double max_exposure_s = 8e-3;
  double max_gain = 4.0;                   ///< analogue, after the exposure is exhausted
  double target_dn = 100.0;                ///< mean grey value that auto exposure aims at
};

/// Throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const CameraModel& model);
CameraIntrinsics intrinsics_of(const CameraModel& model);

/// Turns linear luminance into 8-bit frames. Auto exposure reacts to the previous frame, so frames come in order.
class Camera {
 public:
  Camera(CameraModel model, std::uint64_t seed);

  /// Deterministic in (seed, the frames so far).
  CameraFrame expose(const RadianceImage& image, std::int64_t stamp_ns, std::int64_t frame_index);

  const CameraModel& model() const { return model_; }
  bool noise_enabled = true;

 private:
  CameraModel model_;
  std::uint64_t seed_ = 0;
  double exposure_s_ = 2e-3;
  double gain_ = 1.0;
};

}  // namespace plumbline
