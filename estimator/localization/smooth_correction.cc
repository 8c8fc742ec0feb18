#include "estimator/localization/smooth_correction.h"

#include <algorithm>

#include "estimator/geometry/interpolation.h"

namespace plumbline {

SmoothCorrection::SmoothCorrection(const Pose& map_from_odometry, double duration_s)
    : duration_s_(duration_s), from_(map_from_odometry), to_(map_from_odometry) {}

void SmoothCorrection::aim(std::int64_t stamp_ns, const Pose& odometry_from_body, const Pose& map_from_odometry) {
  from_ = map_from_body(stamp_ns, odometry_from_body) * odometry_from_body.inverse();
  to_ = map_from_odometry;
  start_ns_ = stamp_ns;
}

Pose SmoothCorrection::map_from_body(std::int64_t stamp_ns, const Pose& odometry_from_body) const {
  const double s = std::clamp(seconds_between(start_ns_, stamp_ns) / duration_s_, 0.0, 1.0);
  const double eased = s * s * (3.0 - 2.0 * s);  // at rest at both ends
  return interpolate(from_ * odometry_from_body, to_ * odometry_from_body, eased);
}

}  // namespace plumbline
