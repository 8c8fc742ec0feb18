#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"

namespace plumbline {

/// A scan as if all its points had been measured at one time, in B at that time.
struct DeskewedScan {
  std::vector<Eigen::Vector3f> points;   ///< points[i] belongs to scan.points[i]
  std::vector<Eigen::Vector3f> origins;  ///< of the lidar, at least two, every kInterval_ns from the scan's stamp on

  static constexpr std::int64_t kInterval_ns = 1'000'000;
  /// Where the lidar stood when a point was measured: in a fast car metres from where it stands at the end.
  /// @param offset_ns  since the scan's stamp; held at the ends
  Eigen::Vector3f origin(std::int64_t offset_ns) const;
};

/// @param world_from_body  the predicted motion; must cover the scan
DeskewedScan deskew(const LidarScan& scan, const PoseTrack& world_from_body, const Pose& body_from_lidar,
                    std::int64_t reference_ns);

}  // namespace plumbline
