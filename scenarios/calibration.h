#pragma once

#include "estimator/messages.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// The cameras of a rig by their messages' camera_id.
inline constexpr int kMainCamera = 0;
inline constexpr int kRightCamera = 1;
inline constexpr int kDepthCamera = 2;

/// The right camera of a rig with a stereo pair: the main one moved along its own x axis.
Pose pack_from_right_camera(const RigConfig& rig);

/// What a robot with this rig would be told of it: mounting, intrinsics, the rates at which messages come, and the
/// data sheets' noise. Nothing that a seed draws.
Calibration calibration_of(const RigConfig& rig);

/// The same, with the parts of the vehicle that its sensors see, from the vehicle's own description.
Calibration calibration_of(const Scenario& scenario);

}  // namespace plumbline
