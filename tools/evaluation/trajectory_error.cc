#include "tools/evaluation/trajectory_error.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

constexpr std::int64_t kRelativeNs = 1'000'000'000;
constexpr double kLeastDistance = 1e-3;  // [m], below which a truth counts as resting

/// Sums squared errors of the pose that should be the identity.
class ErrorSum {
 public:
  void add(const Pose& error) {
    translation_ += error.translation.squaredNorm();
    rotation_ += log_so3(error.rotation).squaredNorm();
    ++count_;
  }

  std::optional<RootMeanSquare> root_mean_square() const {
    if (count_ == 0) return std::nullopt;
    const double n = static_cast<double>(count_);
    return RootMeanSquare{std::sqrt(translation_ / n), std::sqrt(rotation_ / n) * 180.0 / std::numbers::pi};
  }

 private:
  double translation_ = 0.0;
  double rotation_ = 0.0;
  std::size_t count_ = 0;
};

/// Visits the error of every motion over 1 s: visit(first pair of the motion, error).
template <typename Visit>
void for_each_relative_error(const std::vector<PosePair>& pairs, Visit visit) {
  std::size_t end = 0;
  for (std::size_t start = 0; start < pairs.size(); ++start) {
    while (end < pairs.size() && pairs[end].stamp_ns < pairs[start].stamp_ns + kRelativeNs) ++end;
    if (end == pairs.size()) return;
    const Pose true_motion = pairs[start].truth.inverse() * pairs[end].truth;
    const Pose estimated_motion = pairs[start].estimate.inverse() * pairs[end].estimate;
    visit(pairs[start], true_motion.inverse() * estimated_motion);
  }
}

}  // namespace

double path_length_m(const StampedPoses& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].pose.translation - poses[i - 1].pose.translation).norm();
  }
  return length;
}

std::vector<double> distance_along(const std::vector<PosePair>& pairs) {
  std::vector<double> distance(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    distance[i] = distance[i - 1] + (pairs[i].truth.translation - pairs[i - 1].truth.translation).norm();
  }
  return distance;
}

std::optional<double> drift_percent(const std::vector<PosePair>& aligned_pairs, double distance_m) {
  if (aligned_pairs.empty() || distance_m < kLeastDistance) return std::nullopt;
  const PosePair& last = aligned_pairs.back();
  return 100.0 * (last.estimate.translation - last.truth.translation).norm() / distance_m;
}

std::optional<RootMeanSquare> absolute_error(const std::vector<PosePair>& aligned_pairs) {
  ErrorSum sum;
  for (const PosePair& pair : aligned_pairs) sum.add(pair.truth.inverse() * pair.estimate);
  return sum.root_mean_square();
}

std::optional<RootMeanSquare> relative_error(const std::vector<PosePair>& pairs) {
  ErrorSum sum;
  for_each_relative_error(pairs, [&](const PosePair&, const Pose& error) { sum.add(error); });
  return sum.root_mean_square();
}

std::vector<RootMeanSquare> relative_error_by_second(const std::vector<PosePair>& pairs) {
  std::vector<ErrorSum> sums;
  for_each_relative_error(pairs, [&](const PosePair& start, const Pose& error) {
    const auto second = static_cast<std::size_t>((start.stamp_ns - pairs.front().stamp_ns) / kRelativeNs);
    if (sums.size() <= second) sums.resize(second + 1);
    sums[second].add(error);
  });
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<RootMeanSquare> by_second;
  for (const ErrorSum& sum : sums) by_second.push_back(sum.root_mean_square().value_or(RootMeanSquare{kNone, kNone}));
  return by_second;
}

}  // namespace plumbline
