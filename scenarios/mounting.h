#pragma once

#include "estimator/geometry/pose.h"
#include "scenarios/config_reader.h"

namespace plumbline {

/// The six keys of a mounting: where the thing sits, {x,y,z}_m, and how it is turned, {roll,pitch,yaw}_deg.
/// @param position  where it sits unless the keys say otherwise
Pose read_mounting(ConfigReader& reader, Eigen::Vector3d position);

}  // namespace plumbline
