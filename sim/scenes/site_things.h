#pragma once

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

// Things that stand around buildings. Their frames stand on the ground, in their middle.

/// A trunk and a crown of a few round lumps, up to 0.3 of its height to every side.
void add_site_tree(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_tree, double tall_m);
/// A mast with an arm over +y and a lamp below it, which shines if intensity_cd is not 0.
void add_lamp_post(MjcfWriter& writer, const Pose& world_from_post, double intensity_cd);
/// Looks along +y.
void add_bench(MjcfWriter& writer, const Pose& world_from_bench);
/// A clipped hedge from one place to another, in lengths of differing height.
void add_hedge(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& from, const Eigen::Vector2d& to);
/// A house with a ridged roof along x, `size` over all, the ridge a third higher.
void add_plain_house(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_house,
                     const Eigen::Vector3d& size);
/// A ridged roof along x over a rectangle about the frame's origin, with eaves.
void add_ridged_roof(MjcfWriter& writer, const Pose& world_from_roof, const Eigen::Vector2d& half_size, double rise_m);

}  // namespace plumbline
