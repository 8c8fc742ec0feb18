#pragma once

#include "sim/vehicles/vehicle.h"

namespace plumbline {

/// What people carry.
VehicleInfo walker_vehicle();
VehicleInfo runner_vehicle();
VehicleInfo hand_vehicle();

}  // namespace plumbline
