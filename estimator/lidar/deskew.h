#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"

namespace plumbline {

/// A scan as if all its points had been measured at one time: points[i] belongs to scan.points[i], in B at
/// reference_ns.
/// @param world_from_body  the predicted motion; must cover the scan
std::vector<Eigen::Vector3f> deskew(const LidarScan& scan, const PoseTrack& world_from_body,
                                    const Pose& body_from_lidar, std::int64_t reference_ns);

}  // namespace plumbline
