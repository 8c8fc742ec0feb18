#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"

namespace plumbline {

using StampedPoses = std::vector<PoseTrack::Stamped>;  ///< in time order

/// Truth and estimate of the body at the same instant, each in its own world.
struct PosePair {
  std::int64_t stamp_ns = 0;
  Pose truth;
  Pose estimate;
};

/// The pose at a time, interpolated; outside the track the nearest end's pose is held. `poses` must not be empty.
Pose pose_at(const StampedPoses& poses, std::int64_t stamp_ns);

/// Pairs two tracks at the stamps of the sparser one. The denser is interpolated where it has poses at most 0.2 s apart
/// on both sides, else its nearest pose within 10 ms is taken, else the stamp is left out.
std::vector<PosePair> pair_poses(const StampedPoses& truth, const StampedPoses& estimate);

/// As pair_poses, then goes on to the truth's end with the estimate held at its last pose: the figures must see an
/// estimate that stopped early.
std::vector<PosePair> pair_poses_to_end(const StampedPoses& truth, const StampedPoses& estimate);

}  // namespace plumbline
