#pragma once

#include <Eigen/Core>

#include "estimator/geometry/pose.h"
#include "estimator/messages.h"
#include "estimator/vision/inverse_depth.h"

/// The residual rows of one feature seen in the key-frame l and in the image now c, and their Jacobians with respect to
/// a right perturbation of keyframe_from_body: thesis 5.6-5.8, whitened to units of pixel noise.
namespace plumbline {

/// Of depth now over depth in the key-frame: nearer than this in front of the camera, or behind it, a point has no
/// usable projection.
inline constexpr double kLeastDepthRatio = 0.05;

/// The camera's motion since the key-frame at one candidate pose: what all rows of a linearisation share.
struct CameraMotion {
  Eigen::Matrix3d camera_from_keyframe_rotation = Eigen::Matrix3d::Identity();  ///< R_l^c of 5.5
  Eigen::Vector3d camera_from_keyframe_translation = Eigen::Vector3d::Zero();   ///< t_l^c of 5.5
  Eigen::Matrix3d body_from_camera_rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< camera's origin in B, along the camera's axes
};

CameraMotion camera_motion(const Pose& keyframe_from_body, const Pose& body_from_camera);

/// One feature as tracked: where the key-frame saw it, where it is now, and what is known of its depth.
struct FeatureSighting {
  Eigen::Vector3d keyframe_ray = Eigen::Vector3d::UnitZ();  ///< X-bar^l: normalised so that z = 1
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();          ///< now [px]
  double pixel_sigma = 0.3;                                 ///< [px], of the track from key-frame to now, per axis
  InverseDepth depth;                                       ///< in the key-frame
};

struct PixelRows {
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> jacobian = Eigen::Matrix<double, 2, 6>::Zero();
};

/// The inverse square root of a feature's joint pixel covariance at one motion: tracking noise on both axes, and the
/// depth's uncertainty as the motion shows it, which acts along the epipolar line only. A feature of hardly known
/// depth thus keeps its full weight across that line.
Eigen::Matrix2d reprojection_whitening(const CameraMotion& motion, const CameraIntrinsics& camera,
                                       const FeatureSighting& feature);

/// Rows 5.6 and 5.7 divided by the depth now, that is, the reprojection error, whitened. The whitening is a constant of
/// the problem: were it a function of the pose, the solver could lower the cost by making the noise look larger.
PixelRows reprojection_rows(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature,
                            const Eigen::Matrix2d& whitening);

struct PixelRow {
  double residual = 0.0;
  Vector6d jacobian = Vector6d::Zero();
};

/// Row 5.8 as the distance of the pixel from its epipolar line, whitened by the pixel noise; the normaliser is
/// differentiated too. Where the motion is so small that no line exists, the row fades to zero.
PixelRow epipolar_row(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature);

/// How far the feature moved in the image beyond what the rotation explains [px].
double parallax_px(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature);

/// The ideal pinhole's pixels: what is here never distorts.
Eigen::Vector2d project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera);
/// Of project().
Eigen::Matrix<double, 2, 3> d_pixel_d_point(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera);
/// The ray through a pixel, normalised so that z = 1.
Eigen::Vector3d ray_through(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

}  // namespace plumbline
