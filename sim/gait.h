#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/motion.h"
#include "sim/smooth_noise.h"

namespace plumbline {

/// What a person's steps add to an even motion.
struct StepMotion {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< ahead, left, up [m]
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();    ///< roll, pitch, yaw [rad]
};

/// A walk: up and down with every step, from side to side with every second one, the heel's strike as a short damped
/// swing of the whole. No two steps take exactly the same time.
class WalkingGait {
 public:
  WalkingGait(const MotionConfig& config, std::uint64_t seed);
  /// @param effort  0 at rest, 1 at full speed
  StepMotion at(double time_s, double effort) const;

 private:
  MotionConfig config_;
  RandomStream stream_;
  SmoothNoise unevenness_;
  double phase_;
};

/// A run: on the ground the legs push in half a sine, between the steps all falls freely, and every few steps there is
/// a jump. Times must not go back.
class RunningGait {
 public:
  RunningGait(const MotionConfig& config, std::uint64_t seed);
  StepMotion at(double time_s, double effort);

 private:
  struct Step {
    double start_s = 0.0;  ///< of the contact
    double contact_s = 0.0;
    double flight_s = 0.0;
    double landing_mps = 0.0;  ///< downwards, at the contact's start
    double takeoff_mps = 0.0;
    double end_s() const { return start_s + contact_s + flight_s; }
  };
  Step next_after(const Step& step);
  static double height(const Step& step, double time_s);

  MotionConfig config_;
  RandomStream stream_;
  Step step_;
  int number_ = 0;      // of the step; sides alternate
  int until_jump_ = 0;  // steps
};

}  // namespace plumbline
