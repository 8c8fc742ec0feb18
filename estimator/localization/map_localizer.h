#pragma once

#include <cstdint>

#include "estimator/lidar/scan_matcher.h"
#include "estimator/localization/agreement_gate.h"
#include "estimator/localization/occupancy.h"
#include "estimator/localization/prior_map.h"

namespace plumbline {

/// What holding one stack of scans against the map gave.
struct MapFix {
  MapMatch match;
  ModuleHealth health;
  /// Of map_from_body, right perturbation, within the directions that were solved; zero along the others.
  Matrix6d covariance = Matrix6d::Zero();
};

/// Scan matching against a fixed map (thesis 8.2): the same correspondences, solver and by-pass of degenerate
/// directions as in odometry, from odometry's prediction.
class MapLocalizer {
 public:
  /// @param map_from_start  where odometry's world lies on the map
  MapLocalizer(const Calibration& calibration, const PriorMap& map, const Pose& map_from_start, bool remapping);

  /// @param stack  features in B now
  MapFix locate(std::int64_t stamp_ns, const FeatureCloud& stack, const OdometryReading& odometry);

  const AgreementGate& gate() const { return gate_; }

 private:
  MatchEvidence evidence_of(const FeatureCloud& stack, const SolveResult& solved) const;

  Calibration calibration_;
  ScanMatcher matcher_;
  Occupancy occupancy_;
  AgreementGate gate_;
};

}  // namespace plumbline
