#include "tools/evaluation/consistency.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace plumbline {
namespace {

constexpr std::int64_t kIncrementNs = 1'000'000'000;

/// e^T P^-1 e / 6, or nothing for a P that is no covariance.
std::optional<double> normalised_square(const Vector6d& error, const Matrix6d& covariance) {
  if (!covariance.allFinite() || !error.allFinite()) return std::nullopt;
  const Eigen::LLT<Matrix6d> cholesky(covariance);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const double square = error.dot(cholesky.solve(error)) / 6.0;
  return std::isfinite(square) ? std::optional(square) : std::nullopt;
}

}  // namespace

std::optional<double> nees_mean(const std::vector<Odometry>& odometry, const StampedPoses& truth) {
  if (odometry.empty() || truth.empty()) return std::nullopt;
  double sum = 0.0;
  std::size_t count = 0;
  std::size_t start = 0;
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    // exp(d) before a motion M is exp(Ad(M^-1) d) after it.
    const Pose motion = odometry[i - 1].world_from_body.inverse() * odometry[i].world_from_body;
    const Matrix6d carry = adjoint(motion.inverse());
    covariance = carry * covariance * carry.transpose() + odometry[i].increment_covariance;
    if (odometry[i].stamp_ns < odometry[start].stamp_ns + kIncrementNs) continue;

    const Pose estimated = odometry[start].world_from_body.inverse() * odometry[i].world_from_body;
    const Pose true_motion = pose_at(truth, odometry[start].stamp_ns).inverse() * pose_at(truth, odometry[i].stamp_ns);
    if (const auto square = normalised_square(estimated.local(true_motion), covariance)) {
      sum += *square;
      ++count;
    }
    start = i;
    covariance.setZero();
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

}  // namespace plumbline
