#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A straight tunnel along x, centred at x = 0, open at both ends to an empty, dark outside without any ground. Its
/// walls are smooth: what they are painted with changes every few metres, their shape does not, so that a lidar away
/// from the ends cannot tell where along it is. `rib_spacing_m` adds ribs that can be told. Free for driving: |y| <=
/// width_m / 2 - 1 (section box) or |y| <= 0.4 width_m - 1 (section round), less rib_depth_m.
SceneInfo tunnel_scene();

}  // namespace plumbline
