#include "estimator/solver/mitigations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/geometry/symmetric_eigen.h"

namespace plumbline {
namespace {

// Of the study of Tuna and others, "Informed, Constrained, Aligned" (2024): rows there are not whitened, so that its
// stiffness is given here in units of a row of 2 cm.
constexpr double kStiffness = 440.0 / (0.02 * 0.02);
constexpr double kLargestWeakStep = 0.0014;
constexpr double kNoInformation = 1e-9;

struct Problem {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

Problem problem_of(const std::vector<MatchRow>& rows) {
  Problem problem;
  for (const MatchRow& row : rows) {
    const Vector6d v = row.whitened_weight() * row.jacobian();
    problem.information.noalias() += v * row.jacobian().transpose();
    problem.gradient += row.residual_m * v;
  }
  return problem;
}

/// Sum over the eigenpairs of coefficient(lambda, along) u, `along` being the plain step's part along u.
template <typename Coefficient>
Vector6d by_eigenpairs(const Problem& problem, Coefficient coefficient) {
  const SymmetricEigen<Matrix6d> eigen(problem.information);
  Vector6d step = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double value = eigen.values[i];
    if (value < kNoInformation) continue;
    const Vector6d u = eigen.vectors.col(i);
    step += coefficient(value, -u.dot(problem.gradient) / value, u) * u;
  }
  return step;
}

Vector6d prior_step(const Problem& problem, const StepContext& context) {
  const Matrix6d prior = context.prior_covariance.inverse();
  return -(problem.information + prior).ldlt().solve(problem.gradient + prior * context.moved);
}

Vector6d drpm_step(const Problem& problem, const std::vector<MatchRow>& rows, double range_sigma_m) {
  const Detection detection = detect(Detector::kDrpm, rows, range_sigma_m);
  Vector6d step = Vector6d::Zero();
  for (std::size_t i = 0; i < detection.directions.size(); ++i) {
    const Vector6d& u = detection.directions[i];
    const double value = u.dot(problem.information * u);
    const double probability = 0.5 * std::erfc(-detection.scores[i] / std::numbers::sqrt2);
    if (value > kNoInformation) step -= probability * u.dot(problem.gradient) / value * u;
  }
  return step;
}

}  // namespace

std::string_view to_string(Mitigation mitigation) {
  switch (mitigation) {
    case Mitigation::kNone:
      return "none";
    case Mitigation::kRemapping:
      return "remapping";
    case Mitigation::kTruncatedSvd:
      return "truncated_svd";
    case Mitigation::kTikhonov:
      return "tikhonov";
    case Mitigation::kInequality:
      return "inequality";
    case Mitigation::kDrpmWeighted:
      return "drpm";
    case Mitigation::kConsistentPrior:
      break;
  }
  return "consistent_prior";
}

Vector6d mitigated_step(Mitigation mitigation, const std::vector<MatchRow>& rows, const StepContext& context) {
  if (rows.empty()) return Vector6d::Zero();
  const Problem problem = problem_of(rows);
  if (!problem.information.allFinite() || !problem.gradient.allFinite()) return Vector6d::Zero();
  switch (mitigation) {
    case Mitigation::kNone:
      return by_eigenpairs(problem, [](double, double along, const Vector6d&) { return along; });
    // The whitened Jacobian's singular values are the roots of these eigenvalues: truncating drops the same directions.
    case Mitigation::kTruncatedSvd:
    case Mitigation::kRemapping:
      return by_eigenpairs(problem, [&](double value, double along, const Vector6d&) {
        return value >= context.threshold ? along : 0.0;
      });
    case Mitigation::kTikhonov:
      return by_eigenpairs(problem, [&](double value, double along, const Vector6d&) {
        return value >= context.threshold ? along : along * value / (value + kStiffness);
      });
    case Mitigation::kInequality:
      // In the eigenvectors' basis the directions do not see each other: the bounded optimum is the clamped one.
      return by_eigenpairs(problem, [&](double value, double along, const Vector6d& u) {
        if (value >= context.threshold) return along;
        const double moved = u.dot(context.moved);
        return std::clamp(moved + along, -kLargestWeakStep, kLargestWeakStep) - moved;
      });
    case Mitigation::kDrpmWeighted:
      return drpm_step(problem, rows, context.range_sigma_m);
    case Mitigation::kConsistentPrior:
      break;
  }
  return prior_step(problem, context);
}

}  // namespace plumbline
