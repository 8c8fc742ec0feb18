#include "tools/evaluation/progress.h"

#include <cmath>

namespace plumbline {
namespace {

constexpr std::int64_t kWindowNs = 5'000'000'000;
constexpr double kLeastTravel = 1.0;     // [m] in a window
constexpr double kLeastTravel_m = 1e-3;  // [m] of the whole run

/// Running sums up to each pair, so that any window is a difference.
struct Travel {
  double truth_m = 0.0;
  double estimate_m = 0.0;
};

std::vector<Travel> running_travel(const std::vector<PosePair>& pairs) {
  std::vector<Travel> travel(pairs.size());
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Eigen::Vector3d true_step = pairs[i].truth.translation - pairs[i - 1].truth.translation;
    const Eigen::Vector3d estimated_step = pairs[i].estimate.translation - pairs[i - 1].estimate.translation;
    travel[i] = travel[i - 1];
    const double length = true_step.norm();
    if (length == 0.0) continue;
    travel[i].truth_m += length;
    travel[i].estimate_m += estimated_step.dot(true_step) / length;
  }
  return travel;
}

double ratio(const Travel& from, const Travel& to) {
  return (to.estimate_m - from.estimate_m) / (to.truth_m - from.truth_m);
}

}  // namespace

ProgressRatio progress_ratio(const std::vector<PosePair>& aligned_pairs) {
  ProgressRatio result;
  if (aligned_pairs.empty()) return result;
  const std::vector<Travel> travel = running_travel(aligned_pairs);
  if (travel.back().truth_m > kLeastTravel_m) result.whole = ratio(travel.front(), travel.back());

  std::size_t end = 0;
  for (std::size_t start = 0; start < travel.size(); ++start) {
    while (end < travel.size() && aligned_pairs[end].stamp_ns < aligned_pairs[start].stamp_ns + kWindowNs) ++end;
    if (end == travel.size()) break;
    if (travel[end].truth_m - travel[start].truth_m < kLeastTravel) continue;
    const double candidate = ratio(travel[start], travel[end]);
    if (!result.worst_5s || std::abs(candidate - 1.0) > std::abs(*result.worst_5s - 1.0)) result.worst_5s = candidate;
  }
  return result;
}

}  // namespace plumbline
