#pragma once

#include <cstdint>
#include <optional>

#include "estimator/lidar/features.h"
#include "estimator/lidar/point_tree.h"
#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// Sweep-to-sweep odometry within the growing sweep (thesis 4.3, Algorithm 2): features of the sweep so far against the
/// whole sweep before, with motion that is linear in time.
///
/// Everything stands in the reference frame, B in the middle of the sweep before. Features come as the prediction puts
/// them there (reference_from_body(t) X, by IMU or by the last motion), and what is solved for is what is wrong with
/// that: a motion C that grows linearly from the reference time on, so that (4.5) and (4.6) read, with s the share of
/// the time,
///   X~ = exp(s theta) X' + s tau,  (theta, tau) = C at the newest time.
/// With nothing predicted this is the thesis's own; with an IMU it is its section 4.6.2. Two things differ:
/// - The thesis counts time from the end of the sweep before. But what two sweeps tell is the motion from the middle of
///   one to the middle of the other: an end that is off one way then makes the next sweep's end off the other way, and
///   on real sweeps of an HDL-64E that rings with growing amplitude.
/// - Lines and planes are fitted to up to 16 and 10 neighbours instead of spanned by two and three (4.2, 4.3): the
///   normal then has a fraction of one return's noise.
class SweepOdometry {
 public:
  /// After a longer silence of the lidar the motion is no longer linear, and the sweep before is out of sight of what
  /// is predicted: odometry has to start anew.
  static constexpr std::int64_t kLongestSilence_ns = 2'500'000'000;

  SweepOdometry(const Calibration& calibration, WeakDirections weak);

  /// Begins a sweep. @param last_sweep  features of the sweep before, in B at reference_ns, its middle
  void begin(const FeatureCloud& last_sweep, std::int64_t reference_ns);
  /// Forgets the growing sweep.
  void discard() { sweep_ = {}; }
  /// Replaces the sweep before by a better one of the same; the growing sweep stays.
  void revise(const FeatureCloud& last_sweep);
  bool begun() const { return begun_; }
  std::int64_t reference_ns() const { return reference_ns_; }

  /// Adds features of the growing sweep, predicted into the reference frame; their offset_s counts from reference_ns.
  void add(const FeatureCloud& predicted_in_reference);

  /// Solves for reference_from_body at now_ns, the time up to which features were added, beginning widely at the
  /// prediction.
  /// @param reference_from_body  the prediction at now_ns
  /// @param likely  a motion that may be near the solution: where the search from there finds clearly more support, it
  /// is
  ///                taken
  /// @param effort  how many times the usual number of features to use
  SolveResult solve(std::int64_t now_ns, const PosePrior& reference_from_body,
                    const std::optional<Pose>& likely = std::nullopt, int effort = 1) const;
  /// The same, beginning closely at a motion near the solution.
  SolveResult refine(std::int64_t now_ns, const PosePrior& reference_from_body, const Pose& known, int effort) const;

  /// The sweep's features so far, put by a solution where they were measured, in B at now_ns.
  FeatureCloud corrected(std::int64_t now_ns, const Pose& predicted, const Pose& reference_from_body) const;

 private:
  double sigma_m_;
  double map_sigma_m_;
  WeakDirections weak_;
  bool begun_ = false;
  std::int64_t reference_ns_ = 0;
  PointTree edges_;
  PointTree planes_;
  PointTree clutter_;
  FeatureCloud sweep_;
};

/// What a correction of the newest pose is at a share of the time since the reference (4.5).
/// @param corrected, predicted  reference_from_body at the newest time
Pose linear_share(const Pose& corrected, const Pose& predicted, double share);

}  // namespace plumbline
