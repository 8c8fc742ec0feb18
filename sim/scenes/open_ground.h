#pragma once

#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// Level ground at z = 0 between two corners, in flush patches of differing materials, 8 to 16 m long and wide.
void add_patches(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                 const std::vector<std::string>& materials);

/// Patches between two corners, and one ground of the first material from there to `reach_m` from the origin.
void add_open_ground(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     const std::vector<std::string>& materials, double reach_m);

/// A clear day at noon in early autumn: 20,000 lux from the sky, 60,000 from the sun on a surface that faces it.
void light_by_day(SceneDescription& scene);

}  // namespace plumbline
