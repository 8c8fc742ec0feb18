#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/range_bias.h"
#include "estimator/solver/detectors.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// One set of settings for all scenarios; the reasons stand at the places of use.
struct ScanMatcherConfig {
  double coarse_voxel_m = 10.0;
  double edge_resolution_m = 0.1;
  double plane_resolution_m = 0.4;
  double memory_path_m = 300.0;  ///< nothing older takes part in matching
  /// By how much all of matching is coarser (thesis Table 6.4): cells and neighbourhoods larger, features fewer. What
  /// map() gives stays as fine as it is.
  double resolution_factor = 1.0;
  /// On whitened J^T J. Measured in worlds of known form (16 rings, 1.2 cm): the largest eigenvalue of a degenerate
  /// direction is 110 in a smooth tunnel, 710 on a bare plain, 620 along a round tube; the smallest of any direction is
  /// 34,500 in a corridor with a pair of door frames every 10 m, 204,000 with one every 5 m, 317,000 in a room. This is
  /// the geometric middle of the gap; it asks for 1.4 cm of standard deviation.
  double degeneracy_threshold = 5000.0;
  int max_iterations = 8;
  double rotation_tolerance = 2e-5;     ///< [rad] a smaller step ends a match
  double translation_tolerance = 1e-4;  ///< [m] likewise
  int plane_budget = 1200;              ///< planar features matched of one scan
  int edge_budget = 800;                ///< edge features matched of one scan
  int clutter_budget = 1500;            ///< points of clutter matched of one scan
  int least_features = 50;              ///< fewer matched: nothing is well-conditioned
  double largest_plane_tilt = 0.03;     ///< [rad] one sigma of a fitted plane's normal
  /// [rad] between a fitted plane and its points' own normals, which is several times what biases of the rings tilt
  /// these by; 1 where normals are rougher: of a single line of a turned scanner, or of a map without rings
  double largest_plane_disagreement = 0.05;
  double largest_edge_tilt = 0.05;  ///< [rad] one sigma of a fitted line's direction
};

/// How range biases make successive matches drift. A bias moves a feature along its beam, and as the sensor goes past
/// the beam turns: to the matcher the whole scene creeps. No residual of one match shows it.
struct MatchDrift {
  /// Of the pose (right perturbation) per metre of the sensor's motion in B, for one bias at one sigma each.
  std::vector<Eigen::Matrix<double, 6, 3>> per_metre;
  /// Of the pose, for the bias of each ring: a ring's returns lie on what other rings have laid down, so that each time
  /// all is renewed, new content bends away from the old by as much.
  std::vector<Vector6d> per_renewal;
  double reach_m = 0.0;  ///< root mean square distance of the matched features: moving so far renews them

  /// Covariance of the drift over a step [m]: it goes on alike while the features are renewed, attitude's longer.
  Matrix6d covariance(const Eigen::Vector3d& step_in_body) const;
};

/// Scan-to-map matching (thesis 5.3, eqs. 5.13-5.15): edge points to lines, planar points to
/// planes and clutter to points of a voxel map.
class ScanMatcher {
 public:
  ScanMatcher(const Calibration& calibration, const ScanMatcherConfig& config,
              WeakDirections weak = WeakDirections::kGuessed);
  ScanMatcher(ScanMatcher&&) noexcept;
  ScanMatcher& operator=(ScanMatcher&&) noexcept;
  ~ScanMatcher();

  /// Solves for world_from_body; starts at the prior's mean. With an empty map nothing is well-conditioned.
  /// @param further_rows  of other sensors that take part in the same problem, after the scan's own; empty: none
  SolveResult match(const FeatureCloud& features_in_body, const PosePrior& world_from_body,
                    const Linearizer& further_rows = {});

  /// Stacks the rows of features that were each measured at a pose of their own: for the motion within a sweep.
  /// @param features_in_body  each in B when it was measured
  /// @param world_from_body   by a feature's offset_s
  /// @param measured_s        the offset_s of each feature that rows were stacked for is appended
  void constrain(const FeatureCloud& features_in_body, const std::function<Pose(double offset_s)>& world_from_body,
                 ResidualRows& rows, std::vector<double>& measured_s);

  /// The rows of the last match as they were at its guess, with their robust weights: what detectors of degeneracy see.
  const std::vector<MatchRow>& rows() const;

  /// Of the last match.
  const MatchDrift& drift() const;

  /// Learns from the last match, once: a step [m] after the one before it.
  void learn_range_biases(double step_m);
  /// Scans should be rid of them before features are taken.
  const RangeBiases& range_biases() const;

  /// Merges a scan into the map at a pose and forgets what is older than memory_path_m.
  /// @param path_m           distance travelled so far by the estimate
  /// @param world_from_body  where the estimate takes the body to be, if that is not where the map has it: what map()
  ///                         gives lies there
  void insert(const FeatureCloud& features_in_body, const Pose& map_from_body, double path_m,
              const std::optional<Pose>& world_from_body = std::nullopt);

  /// Everything ever inserted, down-sampled, in a fixed order, in the estimate's world; also what matching has
  /// forgotten.
  std::vector<MapPoint> map() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
