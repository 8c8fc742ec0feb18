#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "estimator/geometry/pose.h"

/// Detectors of degeneracy from the literature, as pure functions of one linearised scan match. Each is written from
/// its published formula; none knows of the truth.
namespace plumbline {

/// One scalar row of a scan match: how far a point lies from its plane, or from a line in one direction across it.
struct MatchRow {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m], in B
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, in B: the direction that the row measures
  double residual_m = 0.0;
  double sigma_m = 0.02;  ///< of the residual
  double weight = 1.0;    ///< robust weight, [0, 1]

  /// The residual's derivative by a right perturbation of world_from_body: [p x n; n].
  Vector6d jacobian() const;
  /// What the row weighs in a sum of squares [1/m^2].
  double whitened_weight() const { return weight / (sigma_m * sigma_m); }
};

enum class Detector {
  kD,           ///< thesis 7.3: the least eigenvalue of the whitened A^T A, plus one
  kImce,        ///< thesis 7.19: the inverse of the greatest eigenvalue of the residuals' variance times (A^T A)^-1
  kIcn,         ///< thesis 7.5: sqrt(least / greatest eigenvalue)
  kCondition,   ///< least / greatest eigenvalue of the unweighted matrix (its inverse, the condition number, is usual)
  kNormalised,  ///< eigenvalue over the sum of all
  kSubBlock,    ///< eigenvalues of the rotation's and the translation's own 3x3 blocks, rotations over the mean range
  kSchur,       ///< DCReg: condition of the blocks' Schur complements
  kXicp,        ///< X-ICP: contributions of the normals along the blocks' eigenvectors, over its limits
  kCoinLio,     ///< COIN-LIO: sum of |n . v| above a half; translation only
  kDrpm         ///< Hatleskog and Alexis: the signal along a direction against the noise in the matrix itself
};
inline constexpr std::array kDetectors = {
    Detector::kD,        Detector::kImce,  Detector::kIcn,  Detector::kCondition, Detector::kNormalised,
    Detector::kSubBlock, Detector::kSchur, Detector::kXicp, Detector::kCoinLio,   Detector::kDrpm};
/// "d", "imce", "icn", "condition", "normalised", "sub_block", "schur", "x_icp", "coin_lio", "drpm"
std::string_view to_string(Detector detector);

/// Directions with how well each is determined in the detector's own measure, the worst first.
struct Detection {
  std::vector<double> scores;        ///< ascending; small is degenerate
  std::vector<Vector6d> directions;  ///< unit in [rad; m]; as many

  double worst() const { return scores.front(); }
};

/// @param range_sigma_m  the data sheet's
/// @returns six directions (three of kCoinLio), all with score 0 if there are fewer than six rows or one is not finite
Detection detect(Detector detector, const std::vector<MatchRow>& rows, double range_sigma_m);

}  // namespace plumbline
