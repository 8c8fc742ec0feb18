#include "estimator/solver/robust_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace plumbline {

void ResidualRows::clear() {
  residuals_.clear();
  jacobians_.clear();
  first_row_.clear();
}

void ResidualRows::reserve(int rows) {
  residuals_.reserve(static_cast<std::size_t>(rows));
  jacobians_.reserve(static_cast<std::size_t>(rows));
  first_row_.reserve(static_cast<std::size_t>(rows));
}

void ResidualRows::add(double residual, const Vector6d& d_residual_d_pose) {
  first_row_.push_back(row_count());
  residuals_.push_back(residual);
  jacobians_.push_back(d_residual_d_pose);
}

void ResidualRows::add(double residual_1, const Vector6d& jacobian_1, double residual_2, const Vector6d& jacobian_2) {
  add(residual_1, jacobian_1);
  residuals_.push_back(residual_2);
  jacobians_.push_back(jacobian_2);
}

int ResidualRows::end_row(int feature) const {
  return feature + 1 < feature_count() ? first_row(feature + 1) : row_count();
}

namespace {

constexpr double kBisquareCut = 6.9459;  // 4.685 / 0.6745, thesis eq. 4.11
constexpr double kMaxLeverage = 0.9;

struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

NormalEquations accumulate(const ResidualRows& rows, const std::vector<double>& weights) {
  NormalEquations sum;
  for (int f = 0; f < rows.feature_count(); ++f) {
    const double w = weights[static_cast<std::size_t>(f)];
    if (w <= 0.0) continue;
    for (int r = rows.first_row(f); r < rows.end_row(f); ++r) {
      const Vector6d weighted = w * rows.jacobian(r);
      sum.information.noalias() += weighted * rows.jacobian(r).transpose();
      sum.gradient += weighted * rows.residual(r);
    }
  }
  return sum;
}

/// A feature's residual as one number that a unit-noise row would have: the root mean square over its rows.
double feature_residual(const ResidualRows& rows, int feature) {
  double sum = 0.0;
  for (int r = rows.first_row(feature); r < rows.end_row(feature); ++r) sum += rows.residual(r) * rows.residual(r);
  return std::sqrt(sum / (rows.end_row(feature) - rows.first_row(feature)));
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median absolute residual; the rows' distribution is symmetric about zero, so zero stands for its median.
double robust_scale(const ResidualRows& rows, double floor, std::vector<double>& scratch) {
  scratch.clear();
  for (int r = 0; r < rows.row_count(); ++r) scratch.push_back(std::abs(rows.residual(r)));
  return scratch.empty() ? floor : std::max(floor, median_of(scratch));
}

/// Bisquare weights (4.11). The leverage h is read from the unweighted normal equations, damped so that it exists.
void bisquare_weights(const ResidualRows& rows, double scale, std::vector<double>& weights) {
  weights.assign(static_cast<std::size_t>(rows.feature_count()), 1.0);
  Matrix6d unweighted = accumulate(rows, weights).information;
  unweighted.diagonal().array() += 1e-9 * unweighted.trace() + 1e-12;
  const Eigen::LDLT<Matrix6d> factor(unweighted);
  for (int f = 0; f < rows.feature_count(); ++f) {
    double leverage = 0.0;
    for (int r = rows.first_row(f); r < rows.end_row(f); ++r) {
      leverage = std::max(leverage, rows.jacobian(r).dot(factor.solve(rows.jacobian(r))));
    }
    leverage = std::clamp(leverage, 0.0, kMaxLeverage);
    const double alpha = feature_residual(rows, f) / (kBisquareCut * scale * std::sqrt(1.0 - leverage));
    const double kept = 1.0 - alpha * alpha;
    weights[static_cast<std::size_t>(f)] = alpha < 1.0 ? kept * kept : 0.0;
  }
}

/// The step that minimises data and prior rows within the well-conditioned directions, thesis 5.20-5.21.
Vector6d remapped_step(const NormalEquations& data, const std::optional<PosePrior>& prior, const Pose& pose,
                       const Spectrum& spectrum) {
  NormalEquations all = data;
  if (prior) {
    const Matrix6d prior_information = prior->covariance.inverse();
    all.information += prior_information;
    all.gradient += prior_information * prior->mean.local(pose);
  }
  const int n = spectrum.well_conditioned;
  const Eigen::MatrixXd basis = spectrum.eigenvectors.rightCols(n);
  const Eigen::MatrixXd reduced = basis.transpose() * all.information * basis;
  return -basis * reduced.ldlt().solve(basis.transpose() * all.gradient);
}

}  // namespace

SolveResult solve(const Pose& guess, const std::optional<PosePrior>& prior, const Linearizer& linearize,
                  const SolverOptions& options) {
  SolveResult result;
  result.pose = guess;
  ResidualRows rows;
  std::vector<double> scratch;
  NormalEquations data;
  const auto relinearize = [&](const Pose& pose) {
    rows.clear();
    linearize(pose, rows);
    result.features = rows.feature_count();
    result.scale = robust_scale(rows, options.scale_floor, scratch);
    bisquare_weights(rows, result.scale, result.weights);
    result.inliers =
        static_cast<int>(std::count_if(result.weights.begin(), result.weights.end(), [](double w) { return w > 0.0; }));
    data = accumulate(rows, result.weights);
  };

  for (result.iterations = 0; result.iterations < options.max_iterations; ++result.iterations) {
    relinearize(result.pose);
    if (result.iterations == 0) {
      result.spectrum = analyse(data.information, options.degeneracy_threshold);
      // Forced 6-DOF trusts all six directions as long as there is anything to solve them from.
      if (!options.remapping && data.information.allFinite()) result.spectrum.well_conditioned = 6;
    }
    if (result.features < options.min_features || result.inliers < options.min_features ||
        result.inliers < options.min_inlier_share * result.features) {
      result.spectrum.well_conditioned = 0;
    }
    if (result.spectrum.well_conditioned == 0) break;
    const Vector6d step =
        remapped_step(data, options.remapping ? prior : std::nullopt, result.pose, result.spectrum);
    if (!step.allFinite()) {
      result.spectrum.well_conditioned = 0;
      break;
    }
    result.pose = result.pose.retract(step);
    if (step.head<3>().norm() < options.rotation_tolerance && step.tail<3>().norm() < options.translation_tolerance) {
      result.converged = true;
      ++result.iterations;
      break;
    }
  }
  if (result.spectrum.well_conditioned == 0) {
    result.pose = guess;
  } else {
    relinearize(result.pose);
  }
  result.information = data.information;
  result.gradient = data.gradient;
  return result;
}

}  // namespace plumbline
