#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/motion.h"

namespace plumbline {

/// A path at one place.
struct PathPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< world [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();   ///< towards its end; of unit length but for the cubic's ripple
  Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  ///< second derivative of position by arc length [1/m]
  double heading() const { return std::atan2(tangent.y(), tangent.x()); }
  /// Of the path's view from above, positive to the left [1/m].
  double turn() const {
    return (tangent.x() * curvature.y() - tangent.y() * curvature.x()) / tangent.head<2>().squaredNorm();
  }
};

/// A twice continuously differentiable way through the world, by arc length: centripetal Catmull-Rom curves through
/// given points, rounded by a moving average over `smoothing_m`, as a uniform cubic B-spline.
class Path {
 public:
  /// Its points are kStep_m apart.
  static constexpr double kStep_m = 0.1;

  /// @param points  at least two, no two neighbours closer than 1 cm
  /// @throws std::invalid_argument otherwise.
  Path(const std::vector<Eigen::Vector3d>& points, double smoothing_m);

  double length_m() const { return length_m_; }
  /// Held at the ends.
  PathPoint at(double along_m) const;
  /// The arc length of the path's point nearest to `place` (seen from above), looked for around `near_m`.
  double nearest(const Eigen::Vector3d& place, double near_m) const;

 private:
  std::vector<Eigen::Vector3d> control_;
  double step_m_ = kStep_m;
  double length_m_ = 0.0;
};

/// The part of a world's route that a motion follows, or else its way-points.
/// @throws std::invalid_argument naming the field that cannot be used.
std::vector<Eigen::Vector3d> points_of(const MotionConfig& config, const World& world);

}  // namespace plumbline
