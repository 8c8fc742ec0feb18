#include "sensors/camera_model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace plumbline {
namespace {

/// Whether each of the image's corners has one ray, and another distance from the axis than anything nearer to it.
bool invertible_over_image(const CameraModel& model) {
  const CameraIntrinsics c = intrinsics_of(model);
  const Eigen::Vector2d corner(0.5 * c.width / c.fx, 0.5 * c.height / c.fy);
  for (const double x : {-corner.x(), corner.x()}) {
    for (const double y : {-corner.y(), corner.y()}) {
      const Eigen::Vector2d distorted(x, y);
      const Eigen::Vector2d ideal = undistort(model.distortion, distorted);
      if (!ideal.allFinite() || (distort(model.distortion, ideal) - distorted).norm() > 1e-9) return false;
      if (ideal.norm() > 3.0 * distorted.norm() || ideal.dot(distorted) <= 0.0) return false;
    }
  }
  return true;
}

}  // namespace

void validate_or_throw(const CameraModel& model) {
  const std::string owner = "camera " + model.name;
  const auto require = [&owner](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(owner + ": " + rule);
  };
  require(model.width > 0 && model.height > 0, "width and height must be positive");
  require(model.horizontal_fov_deg > 0.0 && model.horizontal_fov_deg < 180.0,
          "horizontal_fov_deg must be within (0, 180)");
  require(model.rate_hz > 0.0, "rate_hz must be positive");
  require(model.f_number > 0.0, "f_number must be positive");
  require(invertible_over_image(model), "distortion must be invertible over the whole image");
  validate_or_throw(model.chip, owner);
  validate_or_throw(model.exposure, owner);
  require(!model.rolling_shutter || model.exposure.row_time_s > 0.0, "a rolling shutter needs row_time_s");
  const double span_s = shutter_of(model, {}, model.exposure.max_exposure_s).span_s();
  require(span_s * model.rate_hz <= 1.0 + 1e-9,
          "max_exposure_s, and a rolling shutter's rows, must fit into the frame's period");
}

CameraIntrinsics intrinsics_of(const CameraModel& model, const CameraEffects& effects) {
  const double half_fov = 0.5 * model.horizontal_fov_deg * std::numbers::pi / 180.0;
  const double focal_length = 0.5 * model.width / std::tan(half_fov);
  CameraIntrinsics intrinsics{
      model.width, model.height, focal_length, focal_length, 0.5 * (model.width - 1), 0.5 * (model.height - 1), {}};
  if (effects.distortion) intrinsics.distortion = model.distortion;
  return intrinsics;
}

Shutter shutter_of(const CameraModel& model, const CameraEffects& effects, double exposure_s) {
  const bool rolling = model.rolling_shutter && effects.rolling_shutter;
  return {effects.motion_blur ? exposure_s : 0.0, rolling ? model.exposure.row_time_s : 0.0, model.height};
}

}  // namespace plumbline
