#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/scenes/tunnel_lining.h"

namespace plumbline {

/// A box on a strip of the lining that stands out of it. Its ends face along the tunnel.
struct StandOut {
  std::size_t strip = 0;  ///< of the lining
  double from = 0.0;      ///< s
  double to = 0.0;
  double low = 0.0;  ///< across the strip, from its middle
  double high = 0.0;
  double depth = 0.0;
  std::string material;
};

/// Rings all round, no two gaps the same.
std::vector<StandOut> tunnel_ribs(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining);

/// Pillars, cabinets, flanges and arches at random places and of random sizes, at their deepest.
std::vector<StandOut> tunnel_things(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining);

/// The same with their depths times a factor; what would be flat is left out.
std::vector<StandOut> with_depths_scaled(const std::vector<StandOut>& things, double factor);

void add_stand_outs(MjcfWriter& writer, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining,
                    const std::vector<StandOut>& stand_outs);

}  // namespace plumbline
