#pragma once

#include <cstdint>
#include <deque>

#include "estimator/geometry/pose.h"

namespace plumbline {

/// Seconds between two integer stamps, `later_ns - earlier_ns`.
inline double seconds_between(std::int64_t earlier_ns, std::int64_t later_ns) {
  return static_cast<double>(later_ns - earlier_ns) * 1e-9;
}

/// Geodesic interpolation: rotation along the shortest arc, translation along the chord; ratio 0 gives `a`, 1 gives
/// `b`.
Pose interpolate(const Pose& a, const Pose& b, double ratio);

/// Stamped poses in time order, read between the stamps by `interpolate`.
class PoseTrack {
 public:
  struct Stamped {
    std::int64_t stamp_ns = 0;
    Pose pose;
  };

  /// @throws std::invalid_argument unless stamp_ns is later than the last one.
  void push(std::int64_t stamp_ns, const Pose& pose);
  /// Drops what is not needed to read at or after stamp_ns.
  void forget_before(std::int64_t stamp_ns);
  /// Moves the whole track rigidly: every pose becomes left * pose.
  void premultiply(const Pose& left);

  const std::deque<Stamped>& poses() const { return poses_; }
  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  std::int64_t first_ns() const { return poses_.front().stamp_ns; }
  std::int64_t last_ns() const { return poses_.back().stamp_ns; }
  bool covers(std::int64_t stamp_ns) const { return !empty() && first_ns() <= stamp_ns && stamp_ns <= last_ns(); }

  /// The pose at a time; outside the track the nearest end's pose is held. @throws std::out_of_range when empty.
  Pose at(std::int64_t stamp_ns) const;

 private:
  std::deque<Stamped> poses_;
};

}  // namespace plumbline
