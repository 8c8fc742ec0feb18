#pragma once

#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

// Things that stand in rooms. Their frames stand on the floor. What stands at a wall has the frame of a wall (see
// walls.h): x along it, y into the room, the thing's back at y = 0 and its middle at x = 0; `depth` tells how far it
// comes into the room. What stands free has its middle at the origin.

/// A top on four legs, 0.74 m high, `size` along x and y.
void add_table(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_table, const Eigen::Vector2d& size);
/// Free standing, 0.45 by 0.5 m and 0.9 m high; whoever sits on it looks along x.
void add_chair(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_chair);
/// depth 0.85 m.
void add_sofa(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m);
/// depth 0.32 m.
void add_bookcase(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m, double tall_m);
/// A closed cupboard with doors.
void add_cupboard(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back,
                  const Eigen::Vector3d& width_depth_height);
/// A desk with a screen and papers, depth 0.7 m, and a chair up to 1.2 m from the wall if asked for.
void add_desk(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, bool with_chair);
/// Along the wall, 2 m long, depth 0.95 m.
void add_bed(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back);
/// Counter with sink and stove below wall cupboards, depth 0.62 m.
void add_kitchen(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m);
/// Open steel shelf with crates and boxes, depth 0.5 m.
void add_shelf(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_back, double width_m, double tall_m);
/// A pot with a bush, up to 0.4 of its height wide.
void add_plant(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_plant, double tall_m);
/// A flat picture or board, its middle `height_m` above the floor.
void add_picture(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_wall, double height_m);

}  // namespace plumbline
