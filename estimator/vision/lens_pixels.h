#pragma once

#include <Eigen/Core>

#include "estimator/messages.h"

/// Between the pixels of the image as it came, where corners are found and tracked, and those of the ideal pinhole of
/// the same focal length, in which all geometry is done.
namespace plumbline {

Eigen::Vector2d pinhole_pixel(const CameraIntrinsics& camera, const Eigen::Vector2f& image_pixel);
Eigen::Vector2f image_pixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pinhole_pixel);

/// The pinhole pixels that the image shows, as an upright rectangle around them; without distortion the image's own.
struct PixelBounds {
  Eigen::Vector2d least = Eigen::Vector2d::Zero();
  Eigen::Vector2d most = Eigen::Vector2d::Zero();
};
PixelBounds pinhole_bounds(const CameraIntrinsics& camera);

}  // namespace plumbline
