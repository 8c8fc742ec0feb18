#include "estimator/pipeline/matched_covariance.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

/// Without a match for so many times the usual, odometry alone tells how the pose goes on.
constexpr double kOverdue = 2.5;
/// Increments should be right over so long.
constexpr double kIncrement_s = 1.0;

Matrix6d carried(const Matrix6d& covariance, const Matrix6d& turn) { return turn * covariance * turn.transpose(); }

}  // namespace

void MatchedCovariance::carry(const Pose& before_from_after, const Matrix6d& added, double step_s) {
  const Matrix6d turn = adjoint(before_from_after.inverse());
  map_ = carried(map_, turn);
  since_match_ = carried(since_match_, turn) + added;
  gathered_ = carried(gathered_, turn) + added;
  gathered_s_ += step_s;
  if (gathered_s_ > kOverdue * between_matches_s_ && step_s > 0.0) per_s_ = added / step_s;
}

void MatchedCovariance::match(const SolveResult& solved, const MatchDrift& drift, const Eigen::Vector3d& step_in_body) {
  const Matrix6d determined = solved.spectrum.projector();
  const Matrix6d undetermined = Matrix6d::Identity() - determined;
  const Matrix6d noise = determined_covariance(solved);
  const double renewed = drift.reach_m > 0.0 ? std::min(1.0, step_in_body.norm() / drift.reach_m) : 0.0;
  const Matrix6d of_map = renewed * noise + drift.covariance(step_in_body);
  map_ += of_map;
  since_match_ = undetermined * since_match_ * undetermined + noise;
  between_matches_s_ = std::exchange(gathered_s_, 0.0);
  const Matrix6d gathered = std::exchange(gathered_, Matrix6d::Zero());
  if (between_matches_s_ <= 0.0) return;
  const Matrix6d walk = undetermined * gathered * undetermined + of_map;
  // At both ends of an increment the pose errs by a match's noise, and by what odometry has gathered half-way to the
  // next: that does not add up from match to match.
  const Matrix6d jitter = 2.0 * noise + determined * gathered * determined;
  per_s_ = walk / between_matches_s_ + jitter / kIncrement_s;
}

}  // namespace plumbline
