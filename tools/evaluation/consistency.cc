#include "tools/evaluation/consistency.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace plumbline {
namespace {

constexpr std::int64_t kIncrementNs = 1'000'000'000;

/// Mean over increments of e^T P^-1 e per dimension.
class MeanSquare {
 public:
  /// A P that is no covariance is left out.
  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
    if (!covariance.allFinite() || !error.allFinite()) return;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
    if (cholesky.info() != Eigen::Success) return;
    const double square = error.dot(cholesky.solve(error)) / static_cast<double>(error.size());
    if (!std::isfinite(square)) return;
    sum_ += square;
    ++count_;
  }
  std::optional<double> get() const { return count_ > 0 ? std::optional(sum_ / count_) : std::nullopt; }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

}  // namespace

std::vector<IncrementError> increment_errors(const std::vector<Odometry>& odometry, const StampedPoses& truth) {
  std::vector<IncrementError> increments;
  if (odometry.empty() || truth.empty()) return increments;
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
    increments.push_back({odometry[i].stamp_ns, estimated.local(true_motion), covariance});
    start = i;
    covariance.setZero();
  }
  return increments;
}

std::optional<double> nees_mean(const std::vector<IncrementError>& increments) {
  MeanSquare mean;
  for (const IncrementError& i : increments) mean.add(i.error, i.covariance);
  return mean.get();
}

std::optional<double> nees_degenerate(const std::vector<IncrementError>& increments,
                                      const std::vector<ModuleHealth>& health, Module module) {
  MeanSquare mean;
  const ModuleHealth* last = nullptr;
  auto next = health.begin();
  for (const IncrementError& i : increments) {
    for (; next != health.end() && next->stamp_ns <= i.end_ns; ++next) {
      if (next->module == module) last = &*next;
    }
    if (last == nullptr || last->stamp_ns <= i.end_ns - kIncrementNs || last->well_conditioned >= 6) continue;
    const Eigen::MatrixXd along = last->eigenvectors.leftCols(6 - last->well_conditioned);
    mean.add(along.transpose() * i.error, along.transpose() * i.covariance * along);
  }
  return mean.get();
}

}  // namespace plumbline
