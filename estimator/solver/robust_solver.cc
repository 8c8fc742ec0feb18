#include "estimator/solver/robust_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/so3.h"

namespace plumbline {

void ResidualRows::clear() {
  residuals_.clear();
  jacobians_.clear();
  d_shared_.clear();
  first_row_.clear();
  group_.clear();
}

void ResidualRows::reserve(int rows) {
  residuals_.reserve(static_cast<std::size_t>(rows));
  jacobians_.reserve(static_cast<std::size_t>(rows));
  d_shared_.reserve(static_cast<std::size_t>(rows));
  group_.reserve(static_cast<std::size_t>(rows));
  first_row_.reserve(static_cast<std::size_t>(rows));
}

void ResidualRows::add(double residual, const Vector6d& d_residual_d_pose) {
  first_row_.push_back(row_count());
  group_.push_back(-1);
  residuals_.push_back(residual);
  jacobians_.push_back(d_residual_d_pose);
  d_shared_.push_back(0.0);
}

void ResidualRows::add(double residual_1, const Vector6d& jacobian_1, double residual_2, const Vector6d& jacobian_2) {
  add(residual_1, jacobian_1);
  residuals_.push_back(residual_2);
  jacobians_.push_back(jacobian_2);
  d_shared_.push_back(0.0);
}

void ResidualRows::share(int group, const Eigen::Vector3d& d_point) {
  const auto first = static_cast<std::size_t>(first_row_.back());
  group_.back() = std::clamp(group, 0, kMostGroups - 1);
  // A point in B moves a row as the body's own position does.
  for (std::size_t r = first; r < jacobians_.size(); ++r) d_shared_[r] = jacobians_[r].tail<3>().dot(d_point);
}

void ResidualRows::append(const ResidualRows& other, const Matrix6d& d_other_d_pose) {
  for (const int row : other.first_row_) first_row_.push_back(row_count() + row);
  group_.insert(group_.end(), other.first_row_.size(), -1);
  d_shared_.insert(d_shared_.end(), other.residuals_.size(), 0.0);
  residuals_.insert(residuals_.end(), other.residuals_.begin(), other.residuals_.end());
  for (const Vector6d& jacobian : other.jacobians_) jacobians_.push_back(d_other_d_pose.transpose() * jacobian);
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

/// What the rows of one group say of what they share.
struct SharedEquations {
  Vector6d cross = Vector6d::Zero();
  double information = 0.0;
  double gradient = 0.0;
};
using GroupEquations = std::vector<SharedEquations>;

void add_shared(const ResidualRows& rows, int feature, double weight, GroupEquations& groups) {
  const auto at = static_cast<std::size_t>(rows.group(feature));
  if (groups.size() <= at) groups.resize(at + 1);
  SharedEquations& group = groups[at];
  for (int r = rows.first_row(feature); r < rows.end_row(feature); ++r) {
    const double weighted = weight * rows.d_shared(r);
    group.cross += weighted * rows.jacobian(r);
    group.information += weighted * rows.d_shared(r);
    group.gradient += weighted * rows.residual(r);
  }
}

/// @param groups  gets the equations of each, if it is not null
NormalEquations accumulate(const ResidualRows& rows, const std::vector<double>& weights, GroupEquations* groups) {
  NormalEquations sum;
  if (groups != nullptr) groups->clear();
  for (int f = 0; f < rows.feature_count(); ++f) {
    const double w = weights[static_cast<std::size_t>(f)];
    if (w <= 0.0) continue;
    for (int r = rows.first_row(f); r < rows.end_row(f); ++r) {
      const Vector6d weighted = w * rows.jacobian(r);
      sum.information.noalias() += weighted * rows.jacobian(r).transpose();
      sum.gradient += weighted * rows.residual(r);
    }
    if (groups != nullptr && rows.group(f) >= 0) add_shared(rows, f, w, *groups);
  }
  return sum;
}

/// Schur complement of the groups' unknowns, each with a prior of unit variance.
void eliminate(const GroupEquations& groups, NormalEquations& equations) {
  for (const SharedEquations& group : groups) {
    const Vector6d gain = group.cross / (group.information + 1.0);
    equations.information.noalias() -= gain * group.cross.transpose();
    equations.gradient -= gain * group.gradient;
  }
}

/// A feature's residual as one number that a unit-noise row would have: the root mean square over its rows.
double feature_residual(const ResidualRows& rows, int feature) {
  double sum = 0.0;
  for (int r = rows.first_row(feature); r < rows.end_row(feature); ++r) sum += rows.residual(r) * rows.residual(r);
  return std::sqrt(sum / (rows.end_row(feature) - rows.first_row(feature)));
}

/// Sorting for the median is undefined on NaN, so this is asked first.
bool all_finite(const ResidualRows& rows) {
  for (int r = 0; r < rows.row_count(); ++r) {
    if (!std::isfinite(rows.residual(r)) || !rows.jacobian(r).allFinite()) return false;
  }
  return true;
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
  Matrix6d unweighted = accumulate(rows, weights, nullptr).information;
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

/// Seen from the guess, pose = guess.retract(x): how the pose's own perturbation moves with x.
Matrix6d d_perturbation_d_correction(const Vector6d& correction) {
  Matrix6d d = Matrix6d::Zero();
  d.topLeftCorner<3, 3>() = right_jacobian_so3(correction.head<3>());
  d.bottomRightCorner<3, 3>() = exp_so3(correction.head<3>()).conjugate().toRotationMatrix();
  return d;
}

/// The step of the correction x that minimises data and prior rows within the well-conditioned directions, thesis
/// 5.20-5.21. All steps are taken in the guess's own frame, in which the directions were found: steps in the frame of
/// the moving pose would turn with it, and so leave the well-conditioned subspace.
Vector6d remapped_step(const NormalEquations& data, const std::optional<PosePrior>& prior, const Pose& pose,
                       const Vector6d& correction, const Spectrum& spectrum) {
  NormalEquations all = data;
  if (prior) {
    // The prior's mean need not be the guess; its residual's Jacobian is that of log() on the rotation.
    const Vector6d error = prior->mean.local(pose);
    Matrix6d d_error = Matrix6d::Zero();
    d_error.topLeftCorner<3, 3>() = right_jacobian_so3(error.head<3>()).inverse();
    d_error.bottomRightCorner<3, 3>() = exp_so3(error.head<3>()).toRotationMatrix();
    const Matrix6d prior_information = prior->covariance.inverse();
    all.information += d_error.transpose() * prior_information * d_error;
    all.gradient += d_error.transpose() * (prior_information * error);
  }
  const int n = spectrum.well_conditioned;
  const Eigen::MatrixXd basis = spectrum.eigenvectors.rightCols(n);
  const Eigen::MatrixXd moves = d_perturbation_d_correction(correction) * basis;
  const Eigen::MatrixXd reduced = moves.transpose() * all.information * moves;
  return -basis * reduced.ldlt().solve(moves.transpose() * all.gradient);
}

/// The prior that takes part in the solution.
std::optional<PosePrior> effective_prior(const Pose& guess, const std::optional<PosePrior>& prior,
                                         const SolverOptions& options) {
  switch (options.weak) {
    case WeakDirections::kGuessed:
      return prior;
    case WeakDirections::kForced:
      return std::nullopt;
    case WeakDirections::kPulled:
      break;
  }
  if (!(options.degeneracy_threshold > 0.0)) return std::nullopt;
  return PosePrior{prior ? prior->mean : guess, Matrix6d::Identity() / options.degeneracy_threshold};
}

/// One solve: what the data say at a pose, and the loop that moves it.
class RobustSolve {
 public:
  RobustSolve(const Pose& guess, const std::optional<PosePrior>& prior, const Linearizer& linearize,
              const SolverOptions& options)
      : guess_(guess), prior_(effective_prior(guess, prior, options)), linearize_(linearize), options_(options) {}

  SolveResult run() {
    result_.pose = guess_;
    for (result_.iterations = 0; result_.iterations < options_.max_iterations && !result_.converged;
         ++result_.iterations) {
      relinearize();
      if (result_.iterations == 0) analyse_data();
      if (!usable() || !step()) result_.spectrum.well_conditioned = 0;
      if (result_.spectrum.well_conditioned == 0) break;
    }
    if (result_.spectrum.well_conditioned == 0) {
      result_.pose = guess_;
      result_.converged = false;
    } else {
      relinearize();
    }
    result_.information = data_.information;
    result_.gradient = data_.gradient;
    if (result_.spectrum.well_conditioned > 0) result_.shared = shared_estimates();
    return result_;
  }

 private:
  void relinearize() {
    rows_.clear();
    linearize_(result_.pose, rows_);
    result_.features = rows_.feature_count();
    data_ = {};
    result_.information_of_rows = Matrix6d::Zero();
    result_.inliers = 0;
    result_.weights.assign(static_cast<std::size_t>(result_.features), 0.0);
    if (!all_finite(rows_)) return;
    result_.scale = robust_scale(rows_, options_.scale_floor, scratch_);
    bisquare_weights(rows_, result_.scale, result_.weights);
    result_.inliers = static_cast<int>(
        std::count_if(result_.weights.begin(), result_.weights.end(), [](double w) { return w > 0.0; }));
    data_ = accumulate(rows_, result_.weights, &groups_);
    result_.information_of_rows = data_.information;
    eliminate(groups_, data_);
  }

  /// Of each group given the pose, widened by how well that is known.
  std::vector<SharedEstimate> shared_estimates() const {
    Matrix6d information = data_.information;
    if (prior_) information += prior_->covariance.inverse();
    const Eigen::LDLT<Matrix6d> factor(information);
    std::vector<SharedEstimate> estimates;
    estimates.reserve(groups_.size());
    for (const SharedEquations& group : groups_) {
      const double variance = 1.0 / (group.information + 1.0);
      const Vector6d by_pose = variance * group.cross;
      estimates.push_back({variance * group.gradient, variance + by_pose.dot(factor.solve(by_pose))});
    }
    return estimates;
  }

  void analyse_data() {
    result_.spectrum = analyse(data_.information, options_.degeneracy_threshold);
    result_.weights_at_guess = result_.weights;
    // Without remapping all six directions are trusted as long as there is anything to solve them from.
    if (options_.weak != WeakDirections::kGuessed && data_.information.allFinite())
      result_.spectrum.well_conditioned = 6;
  }

  bool usable() const {
    return result_.features >= options_.min_features && result_.inliers >= options_.min_features &&
           result_.inliers >= options_.min_inlier_share * result_.features;
  }

  bool step() {
    if (result_.spectrum.well_conditioned == 0) return false;
    const Vector6d step = remapped_step(data_, prior_, result_.pose, correction_, result_.spectrum);
    if (!step.allFinite()) return false;
    correction_ += step;
    result_.pose = guess_.retract(correction_);
    result_.converged =
        step.head<3>().norm() < options_.rotation_tolerance && step.tail<3>().norm() < options_.translation_tolerance;
    return true;
  }

  const Pose& guess_;
  std::optional<PosePrior> prior_;
  const Linearizer& linearize_;
  const SolverOptions& options_;
  SolveResult result_;
  ResidualRows rows_;
  std::vector<double> scratch_;
  NormalEquations data_;
  GroupEquations groups_;
  Vector6d correction_ = Vector6d::Zero();
};

}  // namespace

std::vector<double> robust_weights(const ResidualRows& rows, double scale_floor) {
  std::vector<double> weights;
  bisquare_weights(rows, robust_scale(rows, scale_floor, weights), weights);
  return weights;
}

SolveResult solve(const Pose& guess, const std::optional<PosePrior>& prior, const Linearizer& linearize,
                  const SolverOptions& options) {
  return RobustSolve(guess, prior, linearize, options).run();
}

Matrix6d determined_covariance(const SolveResult& solved) {
  const int n = solved.spectrum.well_conditioned;
  if (n == 0) return Matrix6d::Zero();
  const Eigen::MatrixXd basis = solved.spectrum.eigenvectors.rightCols(n);
  const Eigen::MatrixXd information = basis.transpose() * solved.information * basis;
  const Matrix6d covariance = basis * information.ldlt().solve(Eigen::MatrixXd(basis.transpose()));
  return covariance.allFinite() ? covariance : Matrix6d::Zero();
}

}  // namespace plumbline
