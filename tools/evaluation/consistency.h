#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "tools/evaluation/pairing.h"

namespace plumbline {

/// What an estimate got wrong over a second or so, and what it said of that.
struct IncrementError {
  std::int64_t end_ns = 0;
  Vector6d error = Vector6d::Zero();           ///< right perturbation of the increment, in B at its end
  Matrix6d covariance = Matrix6d::Identity();  ///< composed of its outputs' increment covariances
};

/// Of consecutive increments of 1 s.
std::vector<IncrementError> increment_errors(const std::vector<Odometry>& odometry, const StampedPoses& truth);

/// Mean normalised estimation error squared per degree of freedom: 1 is consistent, more is overconfident. Increments
/// whose covariance is not positive definite are left out; nothing when none remains.
std::optional<double> nees_mean(const std::vector<IncrementError>& increments);

/// The same along the directions alone that a module's data left undetermined, as its last report before an increment's
/// end has them; of increments without such a report within their second, nothing.
std::optional<double> nees_degenerate(const std::vector<IncrementError>& increments,
                                      const std::vector<ModuleHealth>& health, Module module);

}  // namespace plumbline
