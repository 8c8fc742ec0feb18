#pragma once

#include <cstdint>
#include <optional>

#include "estimator/geometry/interpolation.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/sweep_assembler.h"
#include "estimator/lidar/sweep_odometry.h"
#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// The second of chapter 7's three stages: sweep against sweep, where another odometry, of vision, predicts the motion
/// and its error is taken to grow linearly over the sweep.
class SweepRefinement {
 public:
  SweepRefinement(const Calibration& calibration, WeakDirections weak);

  /// A whole sweep without its distortion.
  struct Sweep {
    FeatureCloud features;  ///< in B at end_ns
    std::int64_t end_ns = 0;
    /// Since the end of the sweep before: refined, as predicted, and the solve. Nothing is refined in the first sweep.
    Pose last_end_from_end;
    Pose predicted_last_end_from_end;
    SolveResult solved;
  };

  /// Adds a part, and returns the sweep that it ends.
  /// @param odometry_from_body  the predicted motion; must cover the part and the sweep before
  /// @param covariance  of the predicted motion over a sweep
  std::optional<Sweep> add(const LidarScan& part, const PoseTrack& odometry_from_body, const Matrix6d& covariance);

 private:
  FeatureCloud features_of(const LidarScan& scan, const PoseTrack& odometry_from_body, std::int64_t at_ns) const;
  void follow(const LidarScan& part, const PoseTrack& odometry_from_body, const Matrix6d& covariance,
              std::int64_t now_ns);
  Sweep finish(const LidarScan& sweep, const PoseTrack& odometry_from_body);
  Pose predicted(const PoseTrack& odometry_from_body, std::int64_t stamp_ns) const;
  Pose refined(const PoseTrack& odometry_from_body, std::int64_t stamp_ns) const;
  PoseTrack refined_over(const LidarScan& sweep, const PoseTrack& odometry_from_body) const;

  Calibration calibration_;
  WeakDirections weak_;
  SweepAssembler assembler_;
  SweepOdometry odometry_;  ///< its reference is B in the middle of the sweep before
  std::optional<std::int64_t> growing_;
  std::int64_t last_end_ns_ = 0;
  Pose reference_from_last_end_;
  std::int64_t followed_ns_ = 0;  ///< up to where the growing sweep has been followed
  SolveResult motion_;            ///< reference_from_body there
};

}  // namespace plumbline
