#pragma once

#include <vector>

#include "sim/motion.h"

namespace plumbline {

/// What a rotor craft is asked to be at one time. All in the world's axes but the rates, which are in the craft's own.
struct FlightState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< its thrust gives the acceleration
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_change = Eigen::Vector3d::Zero();
};

/// A smooth flight along a path, with the derivatives that a craft's flatness asks of its attitude (Mellinger and
/// Kumar, Minimum snap trajectory generation and control for quadrotors, 2011).
class FlightReference {
 public:
  FlightReference(const MotionConfig& config, const World& world);

  FlightState at(double time_s) const;
  double duration_s() const;
  Trajectory trajectory() const;

 private:
  std::vector<FlightState> states_;  // Course::kStep_s apart
};

}  // namespace plumbline
