#include "estimator/geometry/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace plumbline {

template <typename Matrix>
SymmetricEigen<Matrix>::SymmetricEigen(const Matrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
  converged = solver.info() == Eigen::Success;
}

template struct SymmetricEigen<Eigen::Matrix3d>;
template struct SymmetricEigen<Matrix6d>;
template struct SymmetricEigen<Eigen::MatrixXd>;

}  // namespace plumbline
