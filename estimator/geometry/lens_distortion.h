#pragma once

#include <Eigen/Core>

namespace plumbline {

/// Brown's radial-tangential lens model, as OpenCV and the EuRoC calibrations use it, on the plane z = 1 of a camera's
/// optical frame. All zero: no distortion.
struct LensDistortion {
  double k1 = 0.0;  ///< radial, r^2; negative is a barrel
  double k2 = 0.0;  ///< radial, r^4
  double p1 = 0.0;  ///< tangential
  double p2 = 0.0;

  bool none() const { return k1 == 0.0 && k2 == 0.0 && p1 == 0.0 && p2 == 0.0; }
};

/// Where a lens images the point that a pinhole would image at `ideal` (x/z, y/z).
Eigen::Vector2d distort(const LensDistortion& lens, const Eigen::Vector2d& ideal);

/// The inverse by Newton's method, to 1e-12 where the lens is invertible; elsewhere the last iterate.
Eigen::Vector2d undistort(const LensDistortion& lens, const Eigen::Vector2d& distorted);

}  // namespace plumbline
