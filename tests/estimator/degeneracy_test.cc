#include "estimator/solver/degeneracy.h"

#include <gtest/gtest.h>

#include <limits>

#include "estimator/geometry/symmetric_eigen.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

/// A matrix with known eigenpairs: V diag(values) V^T, V a random rotation of R^6.
struct KnownMatrix {
  Matrix6d eigenvectors;
  Matrix6d matrix;
};

KnownMatrix known_matrix(const Vector6d& eigenvalues, std::uint64_t seed) {
  RandomStream random(seed, "known_matrix");
  Matrix6d draws;
  for (int i = 0; i < 36; ++i) draws.data()[i] = random.gaussian();
  KnownMatrix known;
  known.eigenvectors = SymmetricEigen<Matrix6d>(draws + draws.transpose()).vectors;
  known.matrix = known.eigenvectors * eigenvalues.asDiagonal() * known.eigenvectors.transpose();
  return known;
}

const Vector6d kEigenvalues = (Vector6d() << 5.0, 80.0, 4e3, 2e4, 1e5, 3e6).finished();

TEST(Degeneracy, CountsTheDirectionsAboveTheThresholdInAscendingOrder) {
  const KnownMatrix known = known_matrix(kEigenvalues, 1);
  const Spectrum spectrum = analyse(known.matrix, 1e3);
  EXPECT_LT((spectrum.eigenvalues - kEigenvalues).norm(), 1e-8);
  EXPECT_EQ(spectrum.well_conditioned, 4);
  EXPECT_FALSE(spectrum.is_well_conditioned(1));
  EXPECT_TRUE(spectrum.is_well_conditioned(2));
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(std::abs(spectrum.eigenvectors.col(i).dot(known.eigenvectors.col(i))), 1.0, 1e-9) << i;
  }
}

// A projector built from rows instead of columns of the eigenvectors, or from the wrong end of the spectrum, is
// symmetric and idempotent as well; what tells them apart is that the weak directions vanish and the strong ones stay.
TEST(Degeneracy, ProjectorRemovesWeakAndKeepsStrongDirections) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const KnownMatrix known = known_matrix(kEigenvalues, seed);
    const Matrix6d projector = analyse(known.matrix, 1e3).projector();
    for (int i = 0; i < 6; ++i) {
      const Vector6d v = known.eigenvectors.col(i);
      const Vector6d expected = i < 2 ? Vector6d::Zero().eval() : v;
      EXPECT_LT((projector * v - expected).norm(), 1e-8) << "eigenvalue " << kEigenvalues[i];
    }
  }
}

TEST(Degeneracy, ProjectorIsZeroOrIdentityAtTheExtremes) {
  const KnownMatrix known = known_matrix(kEigenvalues, 3);
  EXPECT_EQ(analyse(known.matrix, 1e9).projector().norm(), 0.0);
  EXPECT_LT((analyse(known.matrix, 0.0).projector() - Matrix6d::Identity()).norm(), 1e-12);
}

TEST(Degeneracy, ANonFiniteMatrixIsWhollyDegenerate) {
  Matrix6d broken = Matrix6d::Identity();
  broken(2, 3) = broken(3, 2) = std::numeric_limits<double>::quiet_NaN();
  const Spectrum spectrum = analyse(broken, 0.0);
  EXPECT_EQ(spectrum.well_conditioned, 0);
  EXPECT_TRUE(spectrum.eigenvalues.allFinite());
}

}  // namespace
}  // namespace plumbline
