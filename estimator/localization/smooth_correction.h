#pragma once

#include <cstdint>

#include "estimator/geometry/pose.h"

namespace plumbline {

/// map_from_odometry as the output sees it: each new value is reached over a while, position and velocity without
/// jumps, so that a controller can fly on the output.
class SmoothCorrection {
 public:
  /// @param duration_s  from one value to the next
  SmoothCorrection(const Pose& map_from_odometry, double duration_s);

  /// Goes from where it is now to a new value. @param odometry_from_body  now: both are blended as seen at the body,
  /// since a small turn about a far origin is a large step
  void aim(std::int64_t stamp_ns, const Pose& odometry_from_body, const Pose& map_from_odometry);

  Pose map_from_body(std::int64_t stamp_ns, const Pose& odometry_from_body) const;

 private:
  double duration_s_;
  std::int64_t start_ns_ = 0;
  Pose from_;
  Pose to_;
};

}  // namespace plumbline
