#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/motion.h"
#include "sim/path.h"

namespace plumbline {

/// Where a motion wants to be, at knots kStep_s apart: at rest first and last, smooth in between.
struct Course {
  static constexpr double kStep_s = 0.01;  ///< every IMU rate's interval falls between two knots

  std::vector<Eigen::Vector3d> position;
  std::vector<double> yaw;      ///< unwrapped
  std::vector<double> effort;   ///< 0 at rest, 1 at full speed: how strongly gait and oscillations show
  std::vector<double> along_m;  ///< of the path; empty for way-points in time
};

/// The straight legs between way-points, corners and changes of speed spread over `smoothing_s`.
Course course_through_waypoints(const MotionConfig& config);

/// A path at the speeds that the configuration allows: its own and its way-points', and what the accelerations along
/// and across the path leave.
enum class Turning { kOnGround, kInAir };  ///< whether only the path's view from above counts as turning
Course course_along(const Path& path, const MotionConfig& config, Turning turning);

/// As course_along, over the route of a configuration; as course_through_waypoints where it names none.
Course course_of(const MotionConfig& config, const World& world);

}  // namespace plumbline
