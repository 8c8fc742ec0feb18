#pragma once

#include "estimator/geometry/pose.h"
#include "sim/random_stream.h"
#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// The largest thing that add_parked_thing() makes stays within this footprint, and below 2.2 m.
inline constexpr double kParkedWidthM = 2.4;   ///< along x of its frame
inline constexpr double kParkedLengthM = 4.6;  ///< along y

/// A car, a van, a tank on feet, a stack of crates, or a group of barrels, drawn from the stream. Boxes, cylinders,
/// capsules and ellipsoids; it stands on z = 0 of its frame, centred.
void add_parked_thing(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_bay);

/// One to three crates on top of each other, at most 1.5 m wide, each turned a little.
/// @param height_limit_m  crates that would reach above it are left out
void add_crates(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_stack, double height_limit_m);

}  // namespace plumbline
