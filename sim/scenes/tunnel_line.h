#pragma once

#include "estimator/geometry/pose.h"

namespace plumbline {

/// The middle of a tunnel's road, by the distance s from the tunnel's middle [m]: straight along x through the origin,
/// then a bend to the left at constant radius, then straight again.
class TunnelLine {
 public:
  static constexpr double kBendRadius_m = 40.0;    ///< a car takes it at 12 m/s with 3.6 m/s^2 across
  static constexpr double kBendPlaceShare = 0.75;  ///< of the length, to the bend's middle: near the far end

  TunnelLine(double length_m, double bend_rad);

  double begin() const { return -half_length_; }
  double end() const { return half_length_; }
  double bend_begin() const { return bend_begin_; }
  double bend_end() const { return bend_end_; }
  bool bends() const { return bend_end_ > bend_begin_; }

  /// x along the tunnel, y to the left, z up; on the road at s.
  Pose frame(double s) const;
  /// The same axes, but with its origin so that local x is s: along the straight part that holds s.
  Pose straight_frame(double s) const;

 private:
  double half_length_;
  double bend_begin_;
  double bend_end_;
};

}  // namespace plumbline
