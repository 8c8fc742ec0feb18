#include "sim/scenes/tunnel_line.h"

#include <algorithm>
#include <cmath>

#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

TunnelLine::TunnelLine(double length_m, double bend_rad)
    : half_length_(length_m / 2.0),
      bend_begin_((kBendPlaceShare - 0.5) * length_m - kBendRadius_m * bend_rad / 2.0),
      bend_end_(bend_begin_ + kBendRadius_m * bend_rad) {}

Pose TunnelLine::frame(double s) const {
  const double yaw = (std::clamp(s, bend_begin_, bend_end_) - bend_begin_) / kBendRadius_m;
  const double before = std::min(s, bend_begin_);
  const double after = std::max(s - bend_end_, 0.0);
  return upright_frame({before + kBendRadius_m * std::sin(yaw) + after * std::cos(yaw),
                        kBendRadius_m * (1.0 - std::cos(yaw)) + after * std::sin(yaw), 0.0},
                       yaw);
}

Pose TunnelLine::straight_frame(double s) const {
  if (s <= bend_begin_ || !bends()) return {};
  Pose at_end = frame(bend_end_);
  at_end.translation = at_end * Eigen::Vector3d(-bend_end_, 0.0, 0.0);
  return at_end;
}

}  // namespace plumbline
