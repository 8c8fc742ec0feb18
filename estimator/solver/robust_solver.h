#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/solver/degeneracy.h"

/// The one solver of vision and scan matching: robust Gauss-Newton on a pose with six unknowns, bisquare weights
/// (thesis eq. 4.11), optional prior rows (5.11, 5.17) and solution remapping (5.21, Algorithm 3).
namespace plumbline {

/// Stacked residual rows, whitened: divided by the standard deviation that sensor noise gives them.
/// Rows added with one call belong to one feature and share one robust weight.
class ResidualRows {
 public:
  void clear();
  void reserve(int rows);
  /// @param d_residual_d_pose  with respect to a right perturbation of the pose, [rotation; translation]
  void add(double residual, const Vector6d& d_residual_d_pose);
  /// Two rows of one feature.
  void add(double residual_1, const Vector6d& jacobian_1, double residual_2, const Vector6d& jacobian_2);
  /// The newest feature's point errs by `d_point` in B, times a number that all features of its group share: unknown,
  /// of mean zero and variance one, such as the range bias of a ring. The solver solves for these, too.
  /// @param group  from 0 on, at most kMostGroups - 1; of a feature whose rows' point moves with the body
  void share(int group, const Eigen::Vector3d& d_point);

  /// The rows of a problem whose pose moves with this one's: its perturbation is d_other_d_pose times ours. No groups.
  void append(const ResidualRows& other, const Matrix6d& d_other_d_pose);

  int row_count() const { return static_cast<int>(residuals_.size()); }
  int feature_count() const { return static_cast<int>(first_row_.size()); }
  double residual(int row) const { return residuals_[static_cast<std::size_t>(row)]; }
  const Vector6d& jacobian(int row) const { return jacobians_[static_cast<std::size_t>(row)]; }
  int first_row(int feature) const { return first_row_[static_cast<std::size_t>(feature)]; }
  int end_row(int feature) const;
  int group(int feature) const { return group_[static_cast<std::size_t>(feature)]; }  ///< -1: errs by itself
  /// Of a row, by what its group shares.
  double d_shared(int row) const { return d_shared_[static_cast<std::size_t>(row)]; }

  static constexpr int kMostGroups = 256;

 private:
  std::vector<double> residuals_;
  std::vector<Vector6d> jacobians_;
  std::vector<double> d_shared_;
  std::vector<int> first_row_;
  std::vector<int> group_;
};

/// Fills `rows` (already cleared) at a pose. The same features must come in the same order for the same pose.
using Linearizer = std::function<void(const Pose& pose, ResidualRows& rows)>;

/// A bisquare weight for each feature of rows that are stacked already, for problems of more than one pose.
/// @param scale_floor  as SolverOptions has it
std::vector<double> robust_weights(const ResidualRows& rows, double scale_floor);

/// A guess with its uncertainty: covariance of a right perturbation of `mean`.
struct PosePrior {
  Pose mean;
  Matrix6d covariance = Matrix6d::Identity();
};

inline constexpr double kUnitNoiseMad = 0.6745;  ///< of Gaussian noise of unit variance

struct SolverOptions {
  int max_iterations = 10;
  double rotation_tolerance = 1e-5;                ///< [rad]
  double translation_tolerance = 1e-5;             ///< [m]
  double degeneracy_threshold = 0.0;               ///< on the eigenvalues of the whitened J^T J
  WeakDirections weak = WeakDirections::kGuessed;  ///< otherwise no projector, and no prior of the caller's
  double scale_floor = kUnitNoiseMad;              ///< least MAD of the whitened residuals
  int min_features = 6;                            ///< fewer: nothing is well-conditioned
  double min_inlier_share = 0.3;                   ///< fewer: nothing is well-conditioned
};

/// What a solution says of the number that a group of features shares, see ResidualRows::share().
struct SharedEstimate {
  double mean = 0.0;
  double variance = 1.0;  ///< 1: nothing is known beyond the prior
};

struct SolveResult {
  Pose pose;          ///< the guess where nothing could be solved
  Spectrum spectrum;  ///< of the data at the first iteration
  /// The data's own normal equations at `pose`: information * d = -gradient, robust weights included, prior excluded,
  /// what groups of features share eliminated.
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  /// J^T J of the rows alone, as if none shared an error.
  Matrix6d information_of_rows = Matrix6d::Zero();
  std::vector<SharedEstimate> shared;  ///< of each group; empty if nothing was solved
  int features = 0;
  int inliers = 0;                       ///< with a weight above zero
  std::vector<double> weights;           ///< per feature, in [0, 1]
  std::vector<double> weights_at_guess;  ///< the same where the spectrum was found
  double scale = 0.0;                    ///< MAD of the whitened residuals, floored
  int iterations = 0;
  bool converged = false;
};

/// Minimises the weighted rows (and the prior's) from a guess.
/// With remapping, each step moves only along the directions that the data determine at the first iteration; along
/// the others the guess stays exactly. Never throws on bad data: the result then has no well-conditioned direction.
SolveResult solve(const Pose& guess, const std::optional<PosePrior>& prior, const Linearizer& linearize,
                  const SolverOptions& options);

/// Covariance of a solution, right perturbation, as its data have it: zero along the directions that they leave
/// undetermined, and all over where no inverse is to be had.
Matrix6d determined_covariance(const SolveResult& solved);

}  // namespace plumbline
