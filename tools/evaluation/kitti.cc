#include "tools/evaluation/kitti.h"

#include <algorithm>
#include <numbers>

#include "estimator/geometry/so3.h"
#include "tools/evaluation/trajectory_error.h"

namespace plumbline {
namespace {

constexpr std::int64_t kStartEveryNs = 1'000'000'000;  // ten of KITTI's frames
constexpr double kFullLength = 800.0;                  // [m]
constexpr double kLeastPath_m = 1e-3;                  // [m]
constexpr int kLengths = 8;
// A segment of the whole path must survive the rounding of its own sum.
constexpr double kRounding = 1.0 - 1e-9;

std::vector<std::size_t> segment_starts(const std::vector<PosePair>& pairs) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (starts.empty() || pairs[i].stamp_ns >= pairs[starts.back()].stamp_ns + kStartEveryNs) starts.push_back(i);
  }
  return starts;
}

Pose segment_error(const PosePair& start, const PosePair& end) {
  const Pose true_motion = start.truth.inverse() * end.truth;
  const Pose estimated_motion = start.estimate.inverse() * end.estimate;
  return estimated_motion.inverse() * true_motion;
}

}  // namespace

KittiError kitti_error(const std::vector<PosePair>& pairs, double distance_m) {
  KittiError result;
  result.scaled = distance_m < kFullLength;
  if (pairs.empty() || distance_m < kLeastPath_m) return result;
  const double full_length = result.scaled ? distance_m : kFullLength;
  const std::vector<double> distance = distance_along(pairs);

  double translation = 0.0;
  double rotation = 0.0;
  std::size_t segments = 0;
  for (const std::size_t start : segment_starts(pairs)) {
    for (int k = 1; k <= kLengths; ++k) {
      const double length = full_length * k / kLengths;
      const auto end = std::lower_bound(distance.begin(), distance.end(), distance[start] + length * kRounding);
      if (end == distance.end()) break;
      const Pose error = segment_error(pairs[start], pairs[static_cast<std::size_t>(end - distance.begin())]);
      translation += error.translation.norm() / length;
      rotation += log_so3(error.rotation).norm() / length;
      ++segments;
    }
  }
  if (segments == 0) return result;
  const double n = static_cast<double>(segments);
  result.translation_percent = 100.0 * translation / n;
  result.rotation_deg_per_m = rotation / n * 180.0 / std::numbers::pi;
  return result;
}

}  // namespace plumbline
