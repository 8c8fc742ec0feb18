#pragma once

#include "estimator/messages.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// What a robot with this rig would be told of it: mounting, intrinsics, the rates at which messages come, and the
/// data sheets' noise. Nothing that a seed draws.
Calibration calibration_of(const RigConfig& rig);

}  // namespace plumbline
