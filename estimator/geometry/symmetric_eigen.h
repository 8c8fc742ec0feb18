#pragma once

#include "estimator/geometry/pose.h"

namespace plumbline {

/// Eigenvalues of a symmetric matrix in ascending order, and the unit eigenvectors that belong to them, column by
/// column. Only the lower triangle of the matrix is read.
///
/// Eigen's solver of more than three rows takes a compiler five to eight seconds wherever a source uses it; this one is
/// compiled once, for the matrices named below.
template <typename Matrix>
struct SymmetricEigen {
  using Values = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1>;

  explicit SymmetricEigen(const Matrix& symmetric);

  Values values;
  Matrix vectors;
  bool converged = false;
};

extern template struct SymmetricEigen<Eigen::Matrix3d>;
extern template struct SymmetricEigen<Matrix6d>;
extern template struct SymmetricEigen<Eigen::MatrixXd>;

}  // namespace plumbline
