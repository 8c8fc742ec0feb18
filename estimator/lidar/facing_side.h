#pragma once

#include <Eigen/Core>

namespace plumbline {

/// Which of the six directions +-x, +-y, +-z a normal faces most, 0..5; 6 for the zero normal of an edge.
/// Points of one cell that face different sides lie on different surfaces (floor and wall, the two faces of a door
/// leaf), and their mean would lie on neither.
inline int facing_side(const Eigen::Vector3f& normal) {
  if (normal.squaredNorm() < 0.25F) return 6;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0.0F ? 1 : 0);
}

}  // namespace plumbline
