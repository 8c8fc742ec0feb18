#pragma once

#include "estimator/geometry/pose.h"

namespace plumbline {

/// A fast odometry that is never corrected, and the rare refinements of its poses, as one pose at the odometry's rate:
/// the last refined pose composed with the motion since (thesis 3.5, Fig. 3.8).
class TransformIntegration {
 public:
  Pose world_from_body(const Pose& odometry_from_body) const { return world_from_odometry_ * odometry_from_body; }
  void refine(const Pose& refined_world_from_body, const Pose& odometry_from_body) {
    world_from_odometry_ = refined_world_from_body * odometry_from_body.inverse();
  }

 private:
  Pose world_from_odometry_;
};

}  // namespace plumbline
