#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scenes/tunnel_lining.h"

namespace plumbline {

/// The unevenness of a rough lining, like sprayed concrete or blasted rock: smooth noise of two scales, 1.5 m and
/// 0.75 m, along the surface's normal, with the rms that the plan asks for. It never repeats along the tunnel.
class TunnelRelief {
 public:
  TunnelRelief(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining);

  /// Where a point of the smooth section goes at s; points on the edge of two strips go the same way for both.
  Eigen::Vector2d displaced(double s, const Eigen::Vector2d& point) const;

 private:
  Eigen::Vector2d inward(const Eigen::Vector2d& point) const;

  double roughness_;
  double middle_height_;
  double mean_radius_;
  std::uint64_t coarse_seed_;
  std::uint64_t fine_seed_;
  std::vector<TunnelStrip> lining_;
};

}  // namespace plumbline
