#pragma once

#include <Eigen/Core>

#include "sim/random_stream.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

/// Frames stand on the ground; x runs along the road, y away from it unless said otherwise.

/// A mast with an arm over the road (towards -y).
/// @returns where its lamp is
Eigen::Vector3d add_street_lamp(Scenery& scenery, const Pose& world_from_foot, double height_m, double arm_m);
/// A short mast with its lamp on top, as along paths.
Eigen::Vector3d add_path_lamp(Scenery& scenery, const Pose& world_from_foot, double height_m);
/// A traffic sign whose face looks back along the road (-x).
void add_traffic_sign(Scenery& scenery, RandomStream& stream, const Pose& world_from_foot);
/// A telegraph pole with cross-arms.
void add_pole(Scenery& scenery, RandomStream& stream, const Pose& world_from_foot);
/// Bins, boxes, bollards, benches, shelters, hoardings: what stands on pavements.
void add_pavement_thing(Scenery& scenery, RandomStream& stream, const Pose& world_from_foot);
void add_bench(Scenery& scenery, const Pose& world_from_foot);

enum class Fence { kBoards, kRails, kWall, kMesh };
/// One stretch of fence from place to place, following the slope between them.
void add_fence(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               Fence fence);

/// A crash barrier of one stretch between places: posts and a rail.
void add_guard_rail(Scenery& scenery, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
/// A concrete barrier's profile from place to place.
void add_concrete_barrier(Scenery& scenery, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
/// A white post with its reflector, as beside country roads.
void add_marker_post(Scenery& scenery, const Pose& world_from_foot);
/// A gantry over a road from y = 0 to y = -span, boards looking back along the road.
void add_sign_gantry(Scenery& scenery, RandomStream& stream, const Pose& world_from_foot, double span_m);

/// An angular boulder.
void add_rock(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& foot, double size_m);

}  // namespace plumbline
