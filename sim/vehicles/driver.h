#pragma once

#include "sim/course.h"
#include "sim/vehicles/wheeled.h"

namespace plumbline {

/// What a driver decides from.
struct DriverView {
  Eigen::Vector3d rear_axle = Eigen::Vector3d::Zero();  ///< its middle, world
  double heading = 0.0;
  double speed_mps = 0.0;
};

struct DriverCommand {
  double acceleration_mps2 = 0.0;  ///< along the path, the slope's share of gravity included
  double turn = 0.0;               ///< curvature to be driven, positive to the left [1/m]
};

/// Follows a path by a timetable: looks ahead along the path for its curvature, steers back to it as a second-order
/// system would, and keeps to the timetable's speed and place.
class Driver {
 public:
  /// The path and its timetable must outlive the driver.
  Driver(const Path& path, const Course& course, const WheeledDesign& design)
      : path_(path), course_(course), design_(design) {}

  /// @param time_s  since the course's start, not before that of the last call
  DriverCommand decide(double time_s, const DriverView& view);

  double along_m() const { return along_m_; }        ///< where the vehicle is on the path
  double off_path_m() const { return off_path_m_; }  ///< how far the rear axle is left of it

 private:
  const Path& path_;
  const Course& course_;
  const WheeledDesign& design_;
  double along_m_ = 0.0;
  double off_path_m_ = 0.0;
};

}  // namespace plumbline
