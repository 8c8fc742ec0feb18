#include "estimator/solver/robust_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

/// Point-to-plane rows in closed form: points in the body, planes in the world, unit noise after whitening.
struct PlaneProblem {
  struct Row {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;
    double offset = 0.0;
  };
  std::vector<Row> rows;
  double sigma = 0.02;

  void operator()(const Pose& pose, ResidualRows& out) const {
    for (const Row& r : rows) {
      const Eigen::Vector3d in_body = pose.rotation.conjugate() * r.normal;
      Vector6d jacobian;
      jacobian << r.point.cross(in_body), in_body;
      out.add((r.normal.dot(pose * r.point) - r.offset) / sigma, jacobian / sigma);
    }
  }
};

const Pose kTruth = {rotation_from_rpy({0.02, -0.03, 0.4}), {3.0, -2.0, 0.5}};

PlaneProblem random_problem(int count, RandomStream& random, bool tunnel_along_x = false) {
  PlaneProblem problem;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d point(random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), random.uniform(-3.0, 3.0));
    Eigen::Vector3d normal(random.gaussian(), random.gaussian(), random.gaussian());
    if (tunnel_along_x) normal.x() = 0.0;
    normal.normalize();
    problem.rows.push_back({point, normal, normal.dot(kTruth * point) + problem.sigma * random.gaussian()});
  }
  return problem;
}

Pose perturbed(double rotation, double translation) {
  Vector6d d;
  d << rotation, -rotation, rotation, translation, translation, -translation;
  return kTruth.retract(d);
}

TEST(RobustSolver, FindsTheLeastSquaresPose) {
  RandomStream random(1, "solver");
  const SolveResult result = solve(perturbed(0.03, 0.1), std::nullopt, random_problem(500, random), {});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.spectrum.well_conditioned, 6);
  EXPECT_EQ(result.features, 500);
  // 500 rows of 2 cm: 1.5 mm and 0.3 mrad expected; five times that.
  const Vector6d error = kTruth.local(result.pose);
  EXPECT_LT(error.tail<3>().norm(), 0.008);
  EXPECT_LT(error.head<3>().norm(), 0.0015);
}

TEST(RobustSolver, RejectsThirtyPercentGrossOutliers) {
  RandomStream random(2, "solver");
  PlaneProblem problem = random_problem(600, random);
  for (std::size_t k = 0; k < problem.rows.size(); k += 3) problem.rows[k].offset += random.uniform(0.5, 3.0);
  const SolveResult result = solve(perturbed(0.005, 0.02), std::nullopt, problem, {.max_iterations = 30});
  EXPECT_EQ(result.spectrum.well_conditioned, 6);
  EXPECT_LT(kTruth.local(result.pose).norm(), 0.01);
  for (std::size_t k = 0; k < problem.rows.size(); k += 3) EXPECT_EQ(result.weights[k], 0.0) << k;
}

TEST(RobustSolver, TheRowsOfAFeatureShareOneWeight) {
  RandomStream random(3, "solver");
  const PlaneProblem problem = random_problem(300, random);
  const Linearizer pairs = [&](const Pose& pose, ResidualRows& out) {
    ResidualRows single;
    problem(pose, single);
    for (int r = 0; r + 1 < single.row_count(); r += 2) {
      out.add(single.residual(r), single.jacobian(r), single.residual(r + 1), single.jacobian(r + 1));
    }
  };
  const SolveResult result = solve(kTruth, std::nullopt, pairs, {});
  EXPECT_EQ(result.features, 150);
  EXPECT_EQ(result.weights.size(), 150U);
  EXPECT_LT(kTruth.local(result.pose).norm(), 0.01);
}

TEST(RobustSolver, LeavesDegenerateDirectionsExactlyAtTheGuess) {
  RandomStream random(4, "solver");
  const PlaneProblem tunnel = random_problem(500, random, true);
  const Pose guess = perturbed(0.05, 0.2);
  const SolveResult result = solve(guess, std::nullopt, tunnel, {.degeneracy_threshold = 100.0});
  ASSERT_EQ(result.spectrum.well_conditioned, 5);
  const Vector6d weak = result.spectrum.eigenvectors.col(0);
  const Eigen::Vector3d axis_in_body = guess.rotation.conjugate() * Eigen::Vector3d::UnitX();
  EXPECT_GT(std::abs(weak.tail<3>().dot(axis_in_body)), 0.999);
  // Over all iterations, though the pose turns by five degrees: the steps stay in the guess's frame. Rounding only.
  EXPECT_LT(std::abs(weak.dot(guess.local(result.pose))), 1e-13);
  const Eigen::Vector3d error = result.pose.translation - kTruth.translation;
  EXPECT_LT(error.tail<2>().norm(), 0.01);
}

// Remapping restricts the least-squares problem to the strong subspace; there the solution must be that of the
// restricted problem, not a mixture (a transposed projector moves strong components as well).
TEST(RobustSolver, SolvesTheStrongSubspaceAsIfTheWeakOneWereKnown) {
  RandomStream random(5, "solver");
  PlaneProblem tunnel = random_problem(500, random, true);
  for (PlaneProblem::Row& r : tunnel.rows) r.offset = r.normal.dot(kTruth * r.point);
  Vector6d d = Vector6d::Zero();
  d.tail<3>() = kTruth.rotation.conjugate() * Eigen::Vector3d(0.3, 0.0, 0.0);  // wrong only along the axis
  d[1] = 0.02;
  const Pose guess = kTruth.retract(d);
  const SolveResult result = solve(guess, std::nullopt, tunnel, {.max_iterations = 20, .degeneracy_threshold = 100.0});
  EXPECT_LT(result.gradient.head<3>().norm() / result.information.norm(), 1e-9);
  EXPECT_LT((result.pose.translation - kTruth.translation).tail<2>().norm(), 1e-6);
  EXPECT_LT(kTruth.local(result.pose).head<3>().norm(), 1e-6);
  EXPECT_NEAR(result.pose.translation.x() - kTruth.translation.x(), guess.translation.x() - kTruth.translation.x(),
              1e-12);
}

TEST(RobustSolver, ThePriorHoldsWeakDirectionsWithoutAThreshold) {
  RandomStream random(6, "solver");
  const PlaneProblem tunnel = random_problem(500, random, true);
  PosePrior prior = {perturbed(0.0, 0.1), Matrix6d::Identity() * 0.01};
  const SolveResult result = solve(kTruth, prior, tunnel, {.max_iterations = 20});
  EXPECT_NEAR(result.pose.translation.x(), prior.mean.translation.x(), 1e-3);
  EXPECT_NEAR(result.pose.translation.y(), kTruth.translation.y(), 0.01);
}

TEST(RobustSolver, AgreesWithTheCombinedNormalEquationsForALargeTurnedPrior) {
  RandomStream random(7, "solver");
  const PlaneProblem problem = random_problem(40, random);
  constexpr double kVariance = 1e-4;
  PosePrior prior = {perturbed(0.2, 0.3), Matrix6d::Identity() * kVariance};
  const SolveResult result = solve(kTruth, prior, problem, {.max_iterations = 50});
  // At the minimum no small move of the pose lowers the cost: prior's plus the data's, checked by central differences.
  const auto prior_cost = [&](const Pose& pose) { return 0.5 * prior.mean.local(pose).squaredNorm() / kVariance; };
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = 1e-6 * Vector6d::Unit(i);
    const double slope = (prior_cost(result.pose.retract(d)) - prior_cost(result.pose.retract(-d))) / 2e-6;
    EXPECT_NEAR(slope + result.gradient[i], 0.0, 1e-2 * std::max(1.0, std::abs(slope))) << i;
  }
}

TEST(RobustSolver, ForcedSixDofIgnoresPriorAndThreshold) {
  RandomStream random(8, "solver");
  const PlaneProblem problem = random_problem(500, random);
  const PosePrior wrong = {perturbed(0.5, 5.0), Matrix6d::Identity() * 1e-12};
  const SolveResult forced =
      solve(kTruth, wrong, problem, {.degeneracy_threshold = 1e12, .weak = WeakDirections::kForced});
  const SolveResult free = solve(kTruth, std::nullopt, problem, {});
  EXPECT_EQ(forced.spectrum.well_conditioned, 6);
  EXPECT_LT(free.pose.local(forced.pose).norm(), 1e-12);
}

// The baseline of thesis ch. 7: no direction stays as guessed, and none is the data's alone either.
TEST(RobustSolver, AConstantPriorPullsEveryDirectionToTheGuess) {
  RandomStream random(10, "solver");
  PlaneProblem tunnel = random_problem(500, random, true);
  for (PlaneProblem::Row& r : tunnel.rows) r.offset = r.normal.dot(kTruth * r.point);
  Vector6d d = Vector6d::Zero();
  d.tail<3>() = kTruth.rotation.conjugate() * Eigen::Vector3d(0.2, 0.05, 0.0);
  const Pose guess = kTruth.retract(d);
  constexpr double kThreshold = 20000.0;
  const SolveResult pulled = solve(guess, std::nullopt, tunnel,
                                   {.max_iterations = 50,
                                    .translation_tolerance = 1e-9,
                                    .degeneracy_threshold = kThreshold,
                                    .weak = WeakDirections::kPulled});
  EXPECT_EQ(pulled.spectrum.well_conditioned, 6);
  const Eigen::Vector3d error = pulled.pose.translation - kTruth.translation;
  EXPECT_NEAR(error.x(), 0.2, 1e-3);  // along the axis nothing speaks against the guess
  // At the minimum data and prior pull alike; 500 walls of 2 cm see y far better than the prior, and still it shows.
  EXPECT_GT(error.y(), 1e-4);
  EXPECT_LT(error.y(), 0.025);
  const Vector6d pull = kThreshold * guess.local(pulled.pose);
  EXPECT_LT((pulled.gradient + pull).tail<3>().norm(), 0.01 * pull.tail<3>().norm());
}

TEST(RobustSolver, NonFiniteRowsSolveNothing) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    RandomStream random(9, "solver");
    PlaneProblem problem = random_problem(100, random);
    problem.rows[50].offset = bad;
    const Pose guess = perturbed(0.01, 0.1);
    const SolveResult result = solve(guess, std::nullopt, problem, {});
    EXPECT_EQ(result.spectrum.well_conditioned, 0);
    EXPECT_EQ(guess.local(result.pose).norm(), 0.0);
    EXPECT_TRUE(result.information.allFinite() && result.gradient.allFinite());
  }
}

TEST(RobustSolver, TooFewRowsSolveNothing) {
  RandomStream random(10, "solver");
  for (const int count : {0, 5}) {
    const SolveResult result = solve(kTruth, std::nullopt, random_problem(count, random), {});
    EXPECT_EQ(result.spectrum.well_conditioned, 0) << count;
    EXPECT_FALSE(result.converged);
  }
}

TEST(RobustSolver, ItsInformationIsTheInverseCovarianceOfItsError) {
  RandomStream random(11, "solver");
  double sum = 0.0;
  constexpr int kTrials = 300;
  for (int k = 0; k < kTrials; ++k) {
    const SolveResult result = solve(kTruth, std::nullopt, random_problem(200, random), {});
    const Vector6d error = result.pose.local(kTruth);
    sum += error.dot(result.information * error) / 6.0;
  }
  // Chi-square over 1800 degrees of freedom: 0.03; the bisquare's mean weight 0.91 and efficiency 0.95 make it 0.96.
  EXPECT_NEAR(sum / kTrials, 0.96, 0.1);
}

/// Sixteen rings, each with a range bias, above ground that is all but level. Four hundred points of a ring average
/// their noise to a millimetre, but not its bias of a centimetre.
TEST(RobustSolver, WhatARingsPointsErrByAlikeIsSolvedForAndInTheCovariance) {
  constexpr int kRings = 16;
  constexpr int kTrials = 40;
  constexpr double kBias = 0.01;
  double sum = 0.0;
  double sum_of_shared = 0.0;
  for (std::uint64_t trial = 1; trial <= kTrials; ++trial) {
    RandomStream random(trial, "rings");
    PlaneProblem problem;
    std::vector<int> rings;
    std::vector<double> shared;  // of each ring, in sigmas
    for (int ring = 0; ring < kRings; ++ring) {
      shared.push_back(random.gaussian());
      const double bias = kBias * shared.back();
      for (int k = 0; k < 400; ++k) {
        const Eigen::Vector3d point(random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), -2.0);
        const Eigen::Vector3d bump(0.05 * random.gaussian(), 0.05 * random.gaussian(), 1.0);
        const Eigen::Vector3d normal = bump.normalized();
        const Eigen::Vector3d seen = point + bias * point.normalized();
        problem.rows.push_back({seen, normal, normal.dot(kTruth * point) + problem.sigma * random.gaussian()});
        rings.push_back(ring);
      }
    }
    const Linearizer with_rings = [&](const Pose& pose, ResidualRows& out) {
      for (std::size_t k = 0; k < problem.rows.size(); ++k) {
        PlaneProblem{{problem.rows[k]}, problem.sigma}(pose, out);
        out.share(rings[k], kBias * problem.rows[k].point.normalized());
      }
    };
    const SolveResult result = solve(perturbed(0.01, 0.05), std::nullopt, with_rings, {});
    const Vector6d error = result.pose.local(kTruth);
    sum += error.dot(result.information * error) / 6.0;
    ASSERT_EQ(result.shared.size(), shared.size());
    for (std::size_t ring = 0; ring < shared.size(); ++ring) {
      const double missed = result.shared[ring].mean - shared[ring];
      sum_of_shared += missed * missed / result.shared[ring].variance / kRings;
      EXPECT_LT(result.shared[ring].variance, 0.3) << "or nothing was learnt";
    }
  }
  // Chi-square over 240 degrees of freedom: 0.09 about 0.96. Taken for noise of each row's own, biases made it 3.9.
  EXPECT_NEAR(sum / kTrials, 0.96, 0.25);
  // A trial's rings share the error of its height: forty numbers that count, 0.22 about 1.
  EXPECT_NEAR(sum_of_shared / kTrials, 1.0, 0.5);
}

}  // namespace
}  // namespace plumbline
