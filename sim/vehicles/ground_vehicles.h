#pragma once

#include "sim/vehicles/vehicle.h"
#include "sim/vehicles/wheeled.h"

namespace plumbline {

/// The four-wheeled vehicles, each by its figures.
VehicleInfo car_vehicle();
VehicleInfo utility_vehicle();
VehicleInfo cart_vehicle();

}  // namespace plumbline
