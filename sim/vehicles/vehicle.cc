#include "sim/vehicles/vehicle.h"

namespace plumbline {

const std::vector<VehicleInfo>& vehicle_library() {
  static const std::vector<VehicleInfo> vehicles;
  return vehicles;
}

}  // namespace plumbline
