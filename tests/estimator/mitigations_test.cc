#include "estimator/solver/mitigations.h"

#include <gtest/gtest.h>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

/// Rows of a smooth tunnel along x whose pose is off by `error`; their normals are a degree off, so that the data hold
/// a wrong opinion of x.
std::vector<MatchRow> tunnel(const Vector6d& error) {
  RandomStream draws(5, "tunnel");
  std::vector<MatchRow> rows;
  for (int i = 0; i < 600; ++i) {
    MatchRow row;
    const int axis = draws.integer(1, 2);
    const double side = draws.integer(0, 1) == 0 ? -1.0 : 1.0;
    row.point = {draws.uniform(-10.0, 10.0), draws.uniform(-2.0, 2.0), draws.uniform(-2.0, 2.0)};
    row.point[axis] = 2.0 * side;
    row.normal =
        (-side * Eigen::Vector3d::Unit(axis) + 0.005 * Eigen::Vector3d(draws.gaussian(), 0.0, 0.0)).normalized();
    row.residual_m = row.jacobian().dot(error) + 0.02 * draws.gaussian();
    rows.push_back(row);
  }
  return rows;
}

Vector6d error() {
  Vector6d e;
  e << 0.01, -0.005, 0.008, 0.0, 0.05, -0.03;
  return e;
}

TEST(Mitigations, AllSolveWhatTheDataDetermine) {
  StepContext context;
  context.prior_covariance.diagonal().setConstant(0.01);
  for (const Mitigation mitigation : kMitigations) {
    SCOPED_TRACE(to_string(mitigation));
    const Vector6d left = error() + mitigated_step(mitigation, tunnel(error()), context);
    // 600 rows of 2 cm: a millimetre; DRPM's probabilities take a little off each direction.
    const double tolerance = mitigation == Mitigation::kDrpmWeighted ? 0.01 : 0.004;
    EXPECT_LT(left.head<3>().norm(), tolerance);
    EXPECT_LT(left.tail<2>().norm(), tolerance);
  }
}

TEST(Mitigations, LeaveTheWeakDirectionToThePredictionWhereNoneDoesNot) {
  StepContext context;
  context.prior_covariance.diagonal().setConstant(1e-6);  // a good prediction
  const auto along = [&](Mitigation mitigation) {
    return std::abs(mitigated_step(mitigation, tunnel(Vector6d::Zero()), context)[3]);
  };
  const double free = along(Mitigation::kNone);
  EXPECT_GT(free, 0.01);  // sigma / sqrt(600) / 0.005: decimetres would be no surprise
  for (const Mitigation mitigation : kMitigations) {
    if (mitigation == Mitigation::kNone) continue;
    EXPECT_LT(along(mitigation), 0.2 * free) << to_string(mitigation);
  }
}

TEST(Mitigations, RemappingAndTruncatedSvdAreOne) {
  const auto rows = tunnel(error());
  const Vector6d difference =
      mitigated_step(Mitigation::kRemapping, rows, {}) - mitigated_step(Mitigation::kTruncatedSvd, rows, {});
  EXPECT_LT(difference.norm(), 1e-9);
}

TEST(Mitigations, TakeNoStepWithoutRows) {
  for (const Mitigation mitigation : kMitigations) EXPECT_EQ(mitigated_step(mitigation, {}, {}).norm(), 0.0);
}

}  // namespace
}  // namespace plumbline
