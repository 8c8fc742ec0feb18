#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "estimator/geometry/interpolation.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/scan_matcher.h"

namespace plumbline {

/// The motion within a slow sweep, which is taken for steady elsewhere: corrections of it at knots an eighth of a
/// second apart, so that the sweep's features, each at its own time, lie on the map. What holds the knots together is
/// that accelerations are white noise (a Gaussian process prior as in Barfoot, State Estimation for Robotics (2017),
/// section 3.4), whose density is learnt from sweep to sweep, so that a cart's sweeps stay straight and a walker's
/// bend.
class SweepBends {
 public:
  /// @param turns  false: attitude is beyond correction
  explicit SweepBends(bool turns) : turns_(turns) {}

  /// Bends a sweep and goes on from it at the next.
  /// @param steady    world_from_body over the sweep as steady motion has it
  /// @param features  in B at the sweep's end by that motion; their offset_s counts from its beginning
  /// @param end       where the whole sweep as it was lies on the map: world_from_body at its end, roughly
  /// @returns world_from_body over the sweep
  PoseTrack bent(const PoseTrack& steady, const FeatureCloud& features, std::int64_t begin_ns, std::int64_t end_ns,
                 const PosePrior& end, ScanMatcher& map);

  /// Shorter sweeps are not worth it.
  static constexpr double kLeastSweep_s = 0.5;

 private:
  using Vector12d = Eigen::Matrix<double, 12, 1>;
  using Matrix12d = Eigen::Matrix<double, 12, 12>;

  /// A map can be wound as the sweeps are that made it: to and fro, a scanner sees each direction early in one sweep
  /// and late in the next, and a body that swings with it, one way and back, would see the same. No residual shows
  /// that. What of the motion goes to and fro with the sweeps, clearly and for long, is taken for it.
  class Winding {
   public:
    /// @param motion  over a sweep
    /// @returns what to add to the next such motion, so that map and motion unwind
    Vector6d unwound(const Vector6d& motion);

   private:
    double sign_ = 1.0;
    int sweeps_ = 0;  ///< seen
    Vector6d last_motion_ = Vector6d::Zero();
    Vector6d mean_ = Vector6d::Zero();  ///< of what alternates
    Vector6d mean_square_ = Vector6d::Zero();
  };

  void begin_at(const Pose& world_from_body);

  bool turns_;
  std::int64_t last_end_ns_ = 0;
  Pose last_but_one_knot_;      ///< world_from_body, of the sweep before
  Pose last_knot_;              ///< at its end
  Matrix12d knots_covariance_;  ///< of the two
  Vector6d density_;            ///< of the accelerations [rad^2/s^3; m^2/s^3]
  int sweeps_ = 0;
  Winding winding_;
};

}  // namespace plumbline
