#pragma once

#include <cstdint>
#include <vector>

#include "sim/trajectory.h"

namespace plumbline {

/// Turns a finely stepped motion into a trajectory. Impacts come out band-limited, as the mount and the housing of a
/// real IMU pass them: a Gaussian low-pass without delay, -3 dB at kCutoff_hz, over positions and attitudes alike,
/// then a knot every kKnot_ns.
class BandLimiter {
 public:
  static constexpr std::int64_t kStep_ns = 1'000'000;
  static constexpr std::int64_t kKnot_ns = 5'000'000;
  static constexpr double kStep_s = 1e-9 * static_cast<double>(kStep_ns);
  static constexpr double kCutoff_hz = 60.0;

  /// A motion that is under way at time 0 is added from so much earlier: a trajectory rests before its first knot and
  /// begins without acceleration, which by then has worn off.
  static constexpr std::int64_t kLead_ns = 100'000'000;

  /// @param first_ns  stamp of the first pose
  explicit BandLimiter(std::int64_t first_ns = 0);

  /// The next pose, kStep_ns after the one before.
  void add(const Pose& pose);
  /// Everything added; the first and last poses are held beyond the ends. At least 20 poses are needed.
  Trajectory finish();

 private:
  using Channels = Eigen::Matrix<double, 7, 1>;
  void push(const Channels& channels);

  std::int64_t first_ns_;
  std::vector<double> kernel_;    // symmetric, its sum is 1
  std::vector<Channels> recent_;  // the kernel's length, as a ring
  std::int64_t pushed_ = 0;
  std::vector<PoseTrack::Stamped> knots_;
};

}  // namespace plumbline
