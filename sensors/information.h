#pragma once

#include <vector>

#include "estimator/messages.h"
#include "sensors/true_returns.h"

/// What a sensor's data can tell at best: exact Fisher information about the sensor's pose, from the truth, and the
/// Cramer-Rao bound that follows. No detector's own matrix enters.
///
/// All six-vectors are right perturbations of world_from_sensor, [rotation; translation] in the sensor's own frame:
/// rotation about the sensor itself [rad], translation [m].
namespace plumbline {

/// Of registering a scan against a perfect map, point to plane: sum of v v^T / sigma^2 with v = [p x n; n]. Each return
/// errs across its surface by the data sheet's figure for a range, whatever the angle: what the beam's width and the
/// encoder add at grazing incidence makes up for the range error's smaller share there.
/// @param range_sigma_m  above zero
Matrix6d lidar_information(const std::vector<SurfacePoint>& points, double range_sigma_m);

/// Of registering an image against a perfect map of its features' points.
/// @param points_in_camera  [m], optical axes; those that are not in front of the camera do not count
/// @param pixel_sigma_px  of each coordinate, above zero
Matrix6d image_information(const std::vector<Eigen::Vector3d>& points_in_camera, const CameraIntrinsics& camera,
                           double pixel_sigma_px);

/// The standard deviations beyond which a direction counts as degenerate.
struct DegeneracyLimits {
  double rotation_rad = 0.0;   ///< of a pure rotation about the sensor
  double translation_m = 0.0;  ///< of a pure translation

  /// A motion's size in units of the limits: 1 where it is as large as the bound may be.
  Vector6d in_limits(const Vector6d& perturbation) const;
};
inline constexpr DegeneracyLimits kLidarLimits{0.5 * 0.017453292519943295, 0.05};
inline constexpr DegeneracyLimits kImageLimits{2.0 * kLidarLimits.rotation_rad, 2.0 * kLidarLimits.translation_m};

/// Within this factor of the limits, either way, a direction is neither called degenerate nor well determined.
inline constexpr double kGreyZone = 1.5;

/// Which directions are degenerate. Directions are those of the bound measured in its limits, so that a rotation and a
/// translation compare; a direction that mixes them is judged by the ellipsoid through the limits of both.
struct DegeneracyLabel {
  enum class Class { kWell, kGrey, kDegenerate };

  Vector6d excess = Vector6d::Zero();  ///< the bound's standard deviation over its limit, descending; at most 1e6
  /// Column i belongs to excess[i]: the motion that is one limit long, [rad; m].
  Matrix6d directions = Matrix6d::Identity();

  /// The number of directions beyond the limit.
  int degenerate() const;
  static Class class_of(double excess);
  /// Of the whole scan or image: of its worst direction.
  Class worst() const { return class_of(excess[0]); }
};

DegeneracyLabel label(const Matrix6d& information, const DegeneracyLimits& limits);

/// The Cramer-Rao bound: covariance of the best unbiased estimate. Directions without information get a variance of
/// 1e12 limits squared, in place of none.
Matrix6d cramer_rao_bound(const Matrix6d& information, const DegeneracyLimits& limits);

}  // namespace plumbline
