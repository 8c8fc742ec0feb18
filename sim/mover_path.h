#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/world.h"

namespace plumbline {

/// Where a mover is at any time: at constant speed along its way, x ahead, rolling over humps, never banked.
class MoverPath {
 public:
  /// @throws std::invalid_argument naming the mover's body if its path has fewer than two points or no length, or its
  /// speed is not finite and positive.
  explicit MoverPath(const Mover& mover);

  Pose at(double time_s) const;
  double speed_mps() const { return speed_mps_; }

 private:
  Eigen::Vector3d position_at(double along_m) const;

  std::vector<Eigen::Vector3d> points_;  ///< of a closed path the first once more at the end
  std::vector<double> along_m_;          ///< of each point
  bool closed_ = false;
  double speed_mps_ = 0.0;
  double start_m_ = 0.0;
};

}  // namespace plumbline
