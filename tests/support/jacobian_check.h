#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "estimator/geometry/pose.h"

namespace plumbline::testing {

/// Checks a row's Jacobian against central differences of its residual, under right perturbations of the pose.
/// The tolerance is relative to the Jacobian's norm: central differences with step h err by O(h^2).
inline void expect_jacobian_near(const std::function<double(const Pose&)>& residual, const Pose& pose,
                                 const Vector6d& jacobian, double relative_tolerance = 1e-6) {
  constexpr double kStep = 1e-5;
  Vector6d numeric;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = kStep * Vector6d::Unit(i);
    numeric[i] = (residual(pose.retract(d)) - residual(pose.retract(-d))) / (2.0 * kStep);
  }
  ASSERT_TRUE(numeric.allFinite());
  EXPECT_LE((numeric - jacobian).norm(), relative_tolerance * (1.0 + jacobian.norm()))
      << "analytic " << jacobian.transpose() << "\nnumeric  " << numeric.transpose();
}

}  // namespace plumbline::testing
