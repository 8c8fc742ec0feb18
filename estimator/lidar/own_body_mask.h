#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/messages.h"

namespace plumbline {

/// Tells returns from what carries the lidar. They move with it: matched, they say that nothing moves, and mapped, they
/// make a wall of where the carrier went.
class OwnBodyMask {
 public:
  OwnBodyMask() = default;
  explicit OwnBodyMask(const Calibration& calibration);

  bool covers(const Eigen::Vector3f& position_in_lidar) const;

 private:
  struct Box {
    Eigen::Matrix3f box_from_lidar_rotation;
    Eigen::Vector3f box_from_lidar_translation;
    Eigen::Vector3f half_size;
  };

  std::vector<Box> boxes_;
  float reach_m_ = 0.0F;  ///< no box is farther from the lidar
};

}  // namespace plumbline
