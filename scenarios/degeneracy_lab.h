#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/solver/detectors.h"
#include "estimator/solver/mitigations.h"
#include "scenarios/scenario.h"
#include "sensors/information.h"
#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {

/// What a detector said of one scan.
struct DetectorReading {
  double score = 0.0;  ///< of its worst direction; small is degenerate
  /// Between the truly degenerate directions and as many of its worst ones, the largest principal angle, rotations
  /// scaled by the scan's mean range; nothing where no direction is degenerate.
  std::optional<double> angle_rad;
};

/// One scan of a run, its true degeneracy, and what the detectors made of it.
struct ScanTrial {
  std::int64_t stamp_ns = 0;                                 ///< of the scan's end
  DegeneracyLabel label;                                     ///< in L at the scan's end
  double mean_range_m = 0.0;                                 ///< of its true returns
  std::array<DetectorReading, kDetectors.size()> detectors;  ///< as kDetectors
  /// Squared error of registering the points that matching selected on the true surfaces, in units of the Cramer-Rao
  /// bound: e^T H e / 6, H the information of those points, or of all returns. 1 is efficient. Nothing unless the scan
  /// is well determined.
  std::optional<double> error_over_selected;
  std::optional<double> error_over_all;
};

struct LabRun {
  std::vector<ScanTrial> scans;
  std::vector<PoseTrack::Stamped> truth;  ///< world_from_body at each scan's end, from the first scan on
  /// As kMitigations: what scan matching that mitigates so makes of it, on a map of its own, from predictions by the
  /// true motion between scans with errors as dead reckoning has them (1 % of the way, millimetres, 0.03 degrees).
  std::array<std::vector<PoseTrack::Stamped>, kMitigations.size()> estimates;
};

/// Moves a scenario's lidar along its true path, matches its (noisy) scans by the estimator's own scan matching on a
/// map kept at the true poses, each from a guess some centimetres off, and asks every detector. No camera, no IMU and
/// no drift take part, so that detectors are judged on the geometry alone. Scans before the map is a second old are
/// left out of `scans`.
/// @param progress  called with the share done; false ends it there
/// @throws InputError as run_session
LabRun run_degeneracy_lab(const Scenario& scenario, const World& world, const RayScene& rays,
                          const std::function<bool(double)>& progress);

/// The largest principal angle between the spans of `found` and `truth`, of which the first may be the smaller.
/// @param range_m  scales rotations to lengths
double largest_principal_angle(const std::vector<Vector6d>& found, const std::vector<Vector6d>& truth, double range_m);

}  // namespace plumbline
