#pragma once

#include <string>

#include "estimator/geometry/lens_distortion.h"
#include "estimator/messages.h"
#include "sensors/auto_exposure.h"
#include "sensors/sensor_chip.h"
#include "sensors/shutter.h"

namespace plumbline {

/// A camera as its data sheet and its calibration describe it.
struct CameraModel {
  std::string name = "wide640";
  int width = 640;
  int height = 360;
  bool colour = false;               ///< red, green and blue in every pixel, white balanced; else grey
  double horizontal_fov_deg = 68.0;  ///< of the pinhole, before distortion
  double rate_hz = 50.0;
  double f_number = 2.0;
  LensDistortion distortion;
  bool rolling_shutter = false;  ///< rows open exposure.row_time_s after each other
  SensorChip chip;
  ExposureControl exposure;
};

/// What of the physics takes part, each for itself.
struct CameraEffects {
  bool motion_blur = true;      ///< else the scene stands still while a row is exposed
  bool vignetting = true;       ///< natural: the fourth power of the cosine of the angle to the axis
  bool distortion = true;       ///< else an ideal pinhole
  bool rolling_shutter = true;  ///< else all rows at once
  bool shot_noise = true;
  bool dark_current = true;
  bool read_noise = true;
};

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const CameraModel& model);

/// What a calibration would find.
CameraIntrinsics intrinsics_of(const CameraModel& model, const CameraEffects& effects = {});

/// How the rows of a frame of some exposure see light.
Shutter shutter_of(const CameraModel& model, const CameraEffects& effects, double exposure_s);

}  // namespace plumbline
