#include "estimator/geometry/interpolation.h"

#include <algorithm>
#include <stdexcept>

#include "estimator/geometry/so3.h"

namespace plumbline {

Pose interpolate(const Pose& a, const Pose& b, double ratio) {
  const Eigen::Vector3d turn = log_so3(a.rotation.conjugate() * b.rotation);
  return {(a.rotation * exp_so3(ratio * turn)).normalized(), a.translation + ratio * (b.translation - a.translation)};
}

void PoseTrack::push(std::int64_t stamp_ns, const Pose& pose) {
  if (!poses_.empty() && stamp_ns <= poses_.back().stamp_ns) {
    throw std::invalid_argument("PoseTrack: stamps must increase");
  }
  poses_.push_back({stamp_ns, pose});
}

void PoseTrack::forget_before(std::int64_t stamp_ns) {
  while (poses_.size() > 2 && poses_[1].stamp_ns <= stamp_ns) poses_.pop_front();
}

void PoseTrack::premultiply(const Pose& left) {
  for (Stamped& stamped : poses_) stamped.pose = left * stamped.pose;
}

Pose PoseTrack::at(std::int64_t stamp_ns) const {
  if (poses_.empty()) throw std::out_of_range("PoseTrack: empty");
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), stamp_ns,
                                      [](const Stamped& s, std::int64_t t) { return s.stamp_ns < t; });
  if (after == poses_.begin()) return poses_.front().pose;
  if (after == poses_.end()) return poses_.back().pose;
  const Stamped& before = *(after - 1);
  const double ratio = seconds_between(before.stamp_ns, stamp_ns) / seconds_between(before.stamp_ns, after->stamp_ns);
  return interpolate(before.pose, after->pose, ratio);
}

}  // namespace plumbline
