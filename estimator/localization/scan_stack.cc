#include "estimator/localization/scan_stack.h"

#include <utility>

namespace plumbline {

void ScanStack::add(std::int64_t stamp_ns, FeatureCloud features, const Pose& odometry_from_body) {
  scans_.push_back({stamp_ns, std::move(features), odometry_from_body});
  while (stamp_ns - scans_.front().stamp_ns >= span_ns_) scans_.pop_front();
}

FeatureCloud ScanStack::in_newest_body() const {
  FeatureCloud all;
  if (scans_.empty()) return all;
  const Pose body_from_odometry = newest_pose().inverse();
  for (const Scan& scan : scans_) {
    FeatureCloud moved = scan.features;
    move(moved, body_from_odometry * scan.odometry_from_body, 0.0F);
    all.edges.insert(all.edges.end(), moved.edges.begin(), moved.edges.end());
    all.planes.insert(all.planes.end(), moved.planes.begin(), moved.planes.end());
  }
  return all;
}

}  // namespace plumbline
