#pragma once

#include "sim/scene_library.h"

namespace plumbline {

/// A tunnel along x, centred at x = 0, open at both ends to an empty, dark outside without any ground; `bend_deg` turns
/// it to the left at three quarters of its length, at a radius of 40 m. Its walls are smooth: what they are painted
/// with changes every few metres, their shape does not, so that a lidar away from the ends cannot tell where along it
/// is. `rib_spacing_m` adds ribs that can be told, `roughness_m` relief, and `axis_facing_percent` pillars, cabinets,
/// pipe flanges and arches, no two alike: the share of a VLP-16's returns from surfaces whose normal is within 60
/// degrees of the axis, on average along the straight part (in the bend the walls ahead face the sensor, too). Free for
/// driving: |y| <= width_m / 2 - 1 (section box) or |y| <= 0.4 width_m - 1 (section round), less rib_depth_m and three
/// times roughness_m; with things on the walls, at least |y| <= 0.28 width_m in a box and 0.18 width_m in a round one.
/// How much at most can face along the axis follows from the section: 25 % but where it is narrow or low and wide.
SceneInfo tunnel_scene();

}  // namespace plumbline
