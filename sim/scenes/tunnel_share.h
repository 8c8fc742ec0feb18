#pragma once

#include <array>
#include <vector>

#include "sim/scenes/tunnel_things.h"

namespace plumbline {

/// The share of a lidar's returns that come from surfaces facing along the tunnel (their normals within 60 degrees of
/// its axis), over places all along its first straight part: a Velodyne VLP-16 (16 lines over +-15 degrees, 100 m),
/// level, 1.5 m above the middle of the road. The tunnel is taken as smooth and straight.
class AxisFacingShare {
 public:
  explicit AxisFacingShare(const TunnelPlan& plan);

  double of(const std::vector<StandOut>& stand_outs) const;

 private:
  /// The azimuths are shared out among the places, so that few rays leave no gaps.
  static constexpr int kFans = 8;

  struct Ray {
    Eigen::Vector3d direction;  ///< s, y, z
    double lining_m;            ///< to the smooth lining or road
  };

  std::vector<double> places_;
  double begin_;
  double end_;
  std::vector<TunnelStrip> lining_;
  std::array<std::vector<Ray>, kFans> fans_;
};

/// The things at the depths that give the plan's share, ribs included.
/// @throws std::invalid_argument if ribs alone give more, or things at their deepest less.
std::vector<StandOut> things_for_share(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining,
                                       const std::vector<StandOut>& ribs);

}  // namespace plumbline
