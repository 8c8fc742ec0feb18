#pragma once

#include <Eigen/Core>

namespace plumbline {

struct RayHit {
  bool hit = false;
  double range_m = 0.0;
  Eigen::Vector3f normal_in_world = Eigen::Vector3f::Zero();  ///< unit, towards the side the ray came from
  int geom = -1;
};

}  // namespace plumbline
