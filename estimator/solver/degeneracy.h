#pragma once

#include "estimator/geometry/pose.h"

/// Degeneracy of a least-squares problem and solution remapping (thesis ch. 7, eqs. 5.19-5.21 and 7.15-7.18).
namespace plumbline {

/// What becomes of the directions that the data of a problem leave undetermined.
enum class WeakDirections {
  kGuessed,  ///< solution remapping: they stay as they were guessed
  kForced,   ///< the data decide them all the same (the thesis's forced 6-DOF)
  kPulled    ///< a constant prior pulls all six to the guess, as little as leaves none undetermined (thesis ch. 7)
};

/// Of an estimator that remaps, or that was told not to.
constexpr WeakDirections weak_directions(bool remapping) {
  return remapping ? WeakDirections::kGuessed : WeakDirections::kForced;
}

/// Eigenpairs of a data matrix A^T A, and which directions its data determine.
struct Spectrum {
  Vector6d eigenvalues = Vector6d::Zero();       ///< ascending
  Matrix6d eigenvectors = Matrix6d::Identity();  ///< column i belongs to eigenvalues[i]
  int well_conditioned = 0;                      ///< the last so many columns lie above the threshold

  bool is_well_conditioned(int i) const { return i >= 6 - well_conditioned; }
  /// P = sum over well-conditioned i of v_i v_i^T: keeps what the data determine, removes the rest.
  Matrix6d projector() const;
};

/// Eigen-decomposes a symmetric matrix; directions with an eigenvalue below the threshold are degenerate.
/// A matrix that is not finite counts as wholly degenerate.
Spectrum analyse(const Matrix6d& information, double threshold);

}  // namespace plumbline
