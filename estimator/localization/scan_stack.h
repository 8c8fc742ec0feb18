#pragma once

#include <cstdint>
#include <deque>

#include "estimator/lidar/features.h"

namespace plumbline {

/// The features of the scans of a while, laid together by odometry (thesis 8.2, Fig. 8.4): more of the scene's
/// structure than one scan holds, and all that is new since the last match.
class ScanStack {
 public:
  explicit ScanStack(std::int64_t span_ns) : span_ns_(span_ns) {}

  /// @param features  in B at stamp_ns; what is older than the span is let go
  void add(std::int64_t stamp_ns, FeatureCloud features, const Pose& odometry_from_body);

  /// In B at the newest scan.
  FeatureCloud in_newest_body() const;
  const Pose& newest_pose() const { return scans_.back().odometry_from_body; }
  void clear() { scans_.clear(); }

 private:
  struct Scan {
    std::int64_t stamp_ns = 0;
    FeatureCloud features;
    Pose odometry_from_body;
  };

  std::int64_t span_ns_;
  std::deque<Scan> scans_;
};

}  // namespace plumbline
