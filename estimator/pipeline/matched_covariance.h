#pragma once

#include <Eigen/Core>

#include "estimator/geometry/pose.h"
#include "estimator/lidar/scan_matcher.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// What is known of a pose that an odometry carries on between matches with a map that it builds itself: covariances of
/// right perturbations. A match makes an end of what odometry has gathered along the directions that it determines;
/// what it leaves undetermined stays, as it does in the pose (thesis eq. 5.21), and enters the map with the scan.
class MatchedCovariance {
 public:
  /// Odometry's step of so many seconds, and what it adds.
  void carry(const Pose& before_from_after, const Matrix6d& added, double step_s);
  /// A match with the map, a step after the one before it.
  void match(const SolveResult& solved, const MatchDrift& drift, const Eigen::Vector3d& step_in_body);

  /// The map lies off by that in the world, which no match mends.
  void displace_map(const Matrix6d& added) { map_ += added; }

  Matrix6d of_world() const { return map_ + since_match_; }     ///< of world_from_body
  const Matrix6d& since_match() const { return since_match_; }  ///< of the pose against the map
  const Matrix6d& per_s() const { return per_s_; }              ///< by which increments of the pose err now [1/s]

 private:
  Matrix6d map_ = Matrix6d::Zero();  ///< of the map around here in the world
  Matrix6d since_match_ = Matrix6d::Zero();
  Matrix6d gathered_ = Matrix6d::Zero();  ///< by odometry since the last match
  Matrix6d per_s_ = Matrix6d::Zero();
  double gathered_s_ = 0.0;         ///< since the last match
  double between_matches_s_ = 0.0;  ///< the last two; 0: none yet
};

}  // namespace plumbline
