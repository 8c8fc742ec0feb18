#pragma once

#include <algorithm>

#include "estimator/estimator.h"

namespace plumbline {

/// Says when an estimator no longer believes its position: its own standard deviation exceeds both 10 m and a tenth of
/// the way travelled. One that drifts by a percent is not lost after kilometres.
class LostWatch {
 public:
  /// To be asked of every output, in order.
  bool lost(const Odometry& odometry) {
    const Eigen::Vector3d& position = odometry.world_from_body.translation;
    if (!position.allFinite()) return true;
    // In steps that noise at the output's rate does not add up in.
    const double step_m = (position - counted_to_).norm();
    if (step_m >= kStep_m) {
      path_m_ += step_m;
      counted_to_ = position;
    }
    const double limit_m = std::max(kSigma_m, kShareOfPath * path_m_);
    return !(odometry.covariance.bottomRightCorner<3, 3>().trace() <= limit_m * limit_m);
  }

 private:
  static constexpr double kStep_m = 1.0;
  static constexpr double kSigma_m = 10.0;
  static constexpr double kShareOfPath = 0.1;

  Eigen::Vector3d counted_to_ = Eigen::Vector3d::Zero();
  double path_m_ = 0.0;
};

}  // namespace plumbline
