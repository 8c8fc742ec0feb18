#pragma once

#include <optional>

#include "estimator/messages.h"
#include "estimator/vision/inverse_depth.h"
#include "estimator/vision/motion_constraints.h"

/// Depth from the camera's own motion for features that the lidar does not see (thesis 3.3 and 5.2): a Gaussian filter
/// on inverse depth that takes one measurement a key-frame and is carried along from key-frame to key-frame. One,
/// because the frames between share the key-frame's patch: their errors are nearly the same, and counting them all
/// would make the depth far too sure of itself.
namespace plumbline {

/// The inverse depth in the key-frame that one later sighting implies, with the standard deviation that the pixel noise
/// and the motion's own error give it.
/// @param motion_relative_error  of the translation's length, which scales all depths alike
/// @returns nothing when the ray lies within 2 degrees of the motion's axis or the sighting is off its epipolar line.
std::optional<InverseDepth> triangulate(const CameraMotion& motion, const CameraIntrinsics& camera,
                                        const FeatureSighting& feature, double motion_relative_error = 0.02);

/// The product of two Gaussians; where they contradict each other the newer one alone.
InverseDepth fuse(const InverseDepth& older, const InverseDepth& newer);

/// The inverse depth of the same point in the camera now; unknown when the point lies behind it.
InverseDepth carried_along(const InverseDepth& in_keyframe, const CameraMotion& motion,
                           const Eigen::Vector3d& keyframe_ray);

/// Good enough to serve as the feature's depth.
bool converged(const InverseDepth& depth);

}  // namespace plumbline
