#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sensors/camera_model.h"
#include "sim/renderer.h"

namespace plumbline {

/// The picture that a camera without distortion takes.
RenderView pinhole_view(const CameraIntrinsics& intrinsics);

/// Brings a pinhole's pictures onto the sensor: distortion by a table of places, bilinearly, and the fall-off of light
/// towards the corners.
class Lens {
 public:
  Lens(const CameraModel& model, const CameraEffects& effects);

  /// The pinhole to draw: the sensor's own without distortion, else of the same focal length and wide enough for all
  /// that the lens sees.
  const RenderView& view() const { return view_; }

  /// Illuminance on the sensor [lx] per luminance of the scene [cd/m^2], for every pixel.
  const std::vector<float>& lux_per_luminance() const { return lux_per_luminance_; }

  /// Adds a picture of `channels` interleaved values to one of the sensor's, row by row with a weight; rows of weight 0
  /// are left as they are.
  void add(std::span<const float> picture, int channels, std::span<const float> row_weights,
           std::span<float> sum) const;

 private:
  /// Where in the picture a pixel of the sensor looks.
  struct Place {
    int upper_left = 0;  ///< pixel index
    float right = 0.0F;  ///< share of the columns' next neighbour
    float below = 0.0F;  ///< of the rows'
  };

  void set_illuminance(const std::vector<Eigen::Vector2f>& rays, double f_number, bool vignetting);
  void widen_view(const std::vector<Eigen::Vector2f>& rays);
  void make_table(const std::vector<Eigen::Vector2f>& rays);
  void add_row(std::span<const float> picture, int channels, int row, float weight, std::span<float> sum) const;

  CameraIntrinsics intrinsics_;
  RenderView view_;
  std::vector<float> lux_per_luminance_;
  std::vector<Place> table_;  ///< empty without distortion
};

}  // namespace plumbline
