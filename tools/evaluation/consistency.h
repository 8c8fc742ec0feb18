#pragma once

#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "tools/evaluation/pairing.h"

namespace plumbline {

/// Mean normalised estimation error squared per degree of freedom of consecutive 1 s increments: 1 is consistent, more
/// is overconfident. Each increment's covariance is composed of its outputs' increment covariances. Increments whose
/// covariance is not positive definite are left out; nothing when none remains.
std::optional<double> nees_mean(const std::vector<Odometry>& odometry, const StampedPoses& truth);

}  // namespace plumbline
