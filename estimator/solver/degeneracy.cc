#include "estimator/solver/degeneracy.h"

#include "estimator/geometry/symmetric_eigen.h"

namespace plumbline {

Matrix6d Spectrum::projector() const {
  const auto kept = eigenvectors.rightCols(well_conditioned);
  return kept * kept.transpose();
}

Spectrum analyse(const Matrix6d& information, double threshold) {
  Spectrum spectrum;
  if (!information.allFinite()) return spectrum;
  const SymmetricEigen<Matrix6d> eigen(information);
  if (!eigen.converged) return spectrum;
  spectrum.eigenvalues = eigen.values.cwiseMax(0.0);
  spectrum.eigenvectors = eigen.vectors;
  for (int i = 0; i < 6; ++i) spectrum.well_conditioned += spectrum.eigenvalues[i] >= threshold ? 1 : 0;
  return spectrum;
}

}  // namespace plumbline
