#include "sim/vehicles/vehicle.h"

#include <algorithm>
#include <stdexcept>

#include "sim/vehicles/carried.h"
#include "sim/vehicles/flying.h"
#include "sim/vehicles/ground_vehicles.h"

namespace plumbline {

const std::vector<VehicleInfo>& vehicle_library() {
  static const std::vector<VehicleInfo> vehicles = {walker_vehicle(),   runner_vehicle(),  hand_vehicle(),
                                                    cart_vehicle(),     utility_vehicle(), car_vehicle(),
                                                    quadrotor_vehicle()};
  return vehicles;
}

const VehicleInfo& vehicle_named(const std::string& name) {
  const std::vector<VehicleInfo>& vehicles = vehicle_library();
  const auto found = std::find_if(vehicles.begin(), vehicles.end(), [&](const auto& v) { return v.name == name; });
  if (found != vehicles.end()) return *found;
  std::string known;
  for (const VehicleInfo& vehicle : vehicles) known += (known.empty() ? "" : ", ") + vehicle.name;
  throw std::invalid_argument("motion: vehicle: found '" + name + "', expected one of " + known);
}

}  // namespace plumbline
