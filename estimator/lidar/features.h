#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/lidar/deskew.h"
#include "estimator/messages.h"

namespace plumbline {

struct FeaturePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m], in B at the scan's reference time
  float intensity = 0.0F;
  /// Unit, in B. Planes: towards the sensor; clutter: across the beams of its ring; edges: zero.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float spread_m = 0.0F;  ///< edges: standard deviation across the edge that the spacing of the beams adds
  float offset_s = 0.0F;  ///< since the scan's stamp: when it was measured, of a plane's cell the mean
  int laser = 0;          ///< of its first return; the lines of a scanner turned by a motor are of one laser
};

/// What matching uses of one scan (thesis 5.12 and the selection rules of ch. 4).
struct FeatureCloud {
  std::vector<FeaturePoint> edges;
  std::vector<FeaturePoint> planes;
  std::vector<FeaturePoint> clutter;  ///< of what has neither at the scan's scale, such as foliage
};

/// Carries features over to another frame, and their times to a stamp that is earlier by later_s.
void move(FeatureCloud& features, const Pose& target_from_source, float later_s);

/// Curvature-based extraction per ring with all rejection rules: taken neighbours, occlusion edges, grazing surfaces.
/// Planes and clutter are dense but evenly spread: the means of the points of each small cell of space.
/// @param scan      raw; gives ring, order and beam geometry
/// @param deskewed  the same scan
FeatureCloud extract_features(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration);

}  // namespace plumbline
