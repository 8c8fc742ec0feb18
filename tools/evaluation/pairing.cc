#include "tools/evaluation/pairing.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace plumbline {
namespace {

constexpr std::int64_t kNearestNs = 10'000'000;
constexpr std::int64_t kMaxGapNs = 200'000'000;

StampedPoses::const_iterator first_not_before(const StampedPoses& poses, std::int64_t stamp_ns) {
  return std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                          [](const PoseTrack::Stamped& s, std::int64_t t) { return s.stamp_ns < t; });
}

Pose between(const PoseTrack::Stamped& before, const PoseTrack::Stamped& after, std::int64_t stamp_ns) {
  return interpolate(before.pose, after.pose,
                     seconds_between(before.stamp_ns, stamp_ns) / seconds_between(before.stamp_ns, after.stamp_ns));
}

/// Reads a track only where it is trustworthy, as pair_poses promises.
std::optional<Pose> supported_pose_at(const StampedPoses& poses, std::int64_t stamp_ns) {
  const auto after = first_not_before(poses, stamp_ns);
  const bool has_after = after != poses.end();
  if (has_after && after->stamp_ns == stamp_ns) return after->pose;
  const bool has_before = after != poses.begin();
  if (has_before && has_after && after->stamp_ns - (after - 1)->stamp_ns <= kMaxGapNs) {
    return between(*(after - 1), *after, stamp_ns);
  }
  if (has_before && stamp_ns - (after - 1)->stamp_ns <= kNearestNs) return (after - 1)->pose;
  if (has_after && after->stamp_ns - stamp_ns <= kNearestNs) return after->pose;
  return std::nullopt;
}

/// Poses per second of the track's own span, to tell the denser from the sparser.
double rate_of(const StampedPoses& poses) {
  if (poses.size() < 2) return 0.0;
  return static_cast<double>(poses.size() - 1) / seconds_between(poses.front().stamp_ns, poses.back().stamp_ns);
}

}  // namespace

Pose pose_at(const StampedPoses& poses, std::int64_t stamp_ns) {
  const auto after = first_not_before(poses, stamp_ns);
  if (after == poses.begin()) return poses.front().pose;
  if (after == poses.end()) return poses.back().pose;
  return after->stamp_ns == stamp_ns ? after->pose : between(*(after - 1), *after, stamp_ns);
}

std::vector<PosePair> pair_poses(const StampedPoses& truth, const StampedPoses& estimate) {
  std::vector<PosePair> pairs;
  if (truth.empty() || estimate.empty()) return pairs;
  const bool at_truth = rate_of(truth) <= rate_of(estimate);
  const StampedPoses& sparse = at_truth ? truth : estimate;
  const StampedPoses& dense = at_truth ? estimate : truth;
  pairs.reserve(sparse.size());
  for (const auto& [stamp_ns, pose] : sparse) {
    if (const auto other = supported_pose_at(dense, stamp_ns)) {
      pairs.push_back(at_truth ? PosePair{stamp_ns, pose, *other} : PosePair{stamp_ns, *other, pose});
    }
  }
  return pairs;
}

std::vector<PosePair> pair_poses_to_end(const StampedPoses& truth, const StampedPoses& estimate) {
  std::vector<PosePair> pairs = pair_poses(truth, estimate);
  if (pairs.empty()) return pairs;
  const std::int64_t last_paired_ns = pairs.back().stamp_ns;
  for (auto held = first_not_before(truth, last_paired_ns + 1); held != truth.end(); ++held) {
    pairs.push_back({held->stamp_ns, held->pose, pose_at(estimate, held->stamp_ns)});
  }
  return pairs;
}

}  // namespace plumbline
