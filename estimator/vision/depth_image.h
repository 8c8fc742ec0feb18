#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/messages.h"

namespace plumbline {

/// The points of a depth image in its camera's frame, thinned to about one per `angular_spacing_deg`, row by row.
/// Pixels without depth, and those beside a jump of depth, where devices mix two surfaces, give none.
std::vector<Eigen::Vector3f> depth_image_points(const DepthFrame& frame, const CameraIntrinsics& camera,
                                                double angular_spacing_deg);

}  // namespace plumbline
