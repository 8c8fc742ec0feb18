#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "estimator/solver/detectors.h"

/// What a scan matcher can do about degeneracy: one Gauss-Newton step, in the ways that the literature compares.
namespace plumbline {

enum class Mitigation {
  kNone,            ///< the data decide everything
  kRemapping,       ///< thesis 5.21: the solution's part along the weak directions is left out
  kTruncatedSvd,    ///< singular values of the whitened rows below the threshold's root are left out
  kTikhonov,        ///< the weak directions are made stiff
  kInequality,      ///< the step along each weak direction is bounded
  kDrpmWeighted,    ///< each direction by the probability that its signal stands out of the noise
  kConsistentPrior  ///< the prediction takes part with its own covariance
};
inline constexpr std::array kMitigations = {
    Mitigation::kNone,       Mitigation::kRemapping,    Mitigation::kTruncatedSvd,   Mitigation::kTikhonov,
    Mitigation::kInequality, Mitigation::kDrpmWeighted, Mitigation::kConsistentPrior};
/// "none", "remapping", "truncated_svd", "tikhonov", "inequality", "drpm", "consistent_prior"
std::string_view to_string(Mitigation mitigation);

/// What a step may go by besides its rows.
struct StepContext {
  double threshold = 5000.0;  ///< eigenvalues of the whitened J^T J below it belong to weak directions
  double range_sigma_m = 0.015;
  Vector6d moved = Vector6d::Zero();                 ///< from the prediction to where the rows were taken
  Matrix6d prior_covariance = Matrix6d::Identity();  ///< of the prediction
};

/// The right perturbation by which the pose should move. Zero for rows that determine nothing at all.
Vector6d mitigated_step(Mitigation mitigation, const std::vector<MatchRow>& rows, const StepContext& context);

}  // namespace plumbline
