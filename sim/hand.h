#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/motion.h"
#include "sim/smooth_noise.h"

namespace plumbline {

/// The slow unrest of a hand that holds something, about and along all axes.
class HandWander {
 public:
  HandWander(double deviation_deg, std::uint64_t seed);
  /// @param share  of the full deviation
  Pose at(double time_s, double share) const;

 private:
  double deviation_;  // [rad]
  std::vector<SmoothNoise> noise_;
};

/// A hand that turns what it holds about ever other axes: a random rate whose magnitude has a given mean and a given
/// peak. The wrist is the pivot, so that what is held swings about it.
class HandSpin {
 public:
  /// @param share  how strongly it spins over time, kStep_s apart, 0 to 1; mean and peak are of where it is above 0
  static constexpr double kStep_s = 0.01;
  HandSpin(const MotionConfig& config, std::vector<double> share, std::uint64_t seed);

  /// Advances by dt_s to time_s.
  void advance(double time_s, double dt_s);
  Pose pose() const;

 private:
  Eigen::Vector3d rate(double time_s) const;  // [rad/s], in the body's axes

  std::vector<double> share_;
  std::vector<SmoothNoise> noise_;
  double power_ = 1.0;
  double scale_ = 0.0;
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();
};

}  // namespace plumbline
