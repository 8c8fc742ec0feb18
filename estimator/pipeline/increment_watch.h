#pragma once

#include <cstdint>

#include "estimator/geometry/interpolation.h"
#include "estimator/imu/inertial_filter.h"

namespace plumbline {

/// Covariance of a filter's increments. The errors of successive steps share their causes, such as the velocity's error
/// and the map's, so that the covariances of single steps could not be composed: each takes its share of the whole
/// second's before it. Besides, an earlier output was given out before corrections moved all of the past with the
/// present: by as much the increment errs as well.
class IncrementWatch {
 public:
  void start_at(std::int64_t stamp_ns) { past_ns_ = stamp_ns; }
  /// After every step of the filter, whose past pose this moves. The track goes back two seconds at least.
  void update(InertialFilter& filter, const PoseTrack& world_from_body);
  Matrix6d covariance(double interval_s) const { return interval_s * (per_s_ + revision_per_s_); }

 private:
  std::int64_t past_ns_ = 0;  ///< stamp of the filter's past pose
  bool complete_ = false;     ///< a whole window has gone by
  Matrix6d per_s_ = Matrix6d::Zero();
  Matrix6d revision_per_s_ = Matrix6d::Zero();
};

}  // namespace plumbline
