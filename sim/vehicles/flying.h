#pragma once

#include "sim/vehicles/vehicle.h"

namespace plumbline {

VehicleInfo quadrotor_vehicle();

/// The motion that the quadrotor's controller is asked to follow; what it is measured against.
Trajectory quadrotor_reference(const MotionConfig& config, const World& world);

}  // namespace plumbline
