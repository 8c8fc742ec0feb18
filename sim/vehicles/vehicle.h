#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/motion.h"

namespace plumbline {

/// A thing that carries the pack of sensors. Its frame is where a pack is bolted on: x forward, z up.
struct VehicleInfo {
  std::string name;
  std::string summary;
  MotionConfig defaults;  ///< what a motion by this vehicle is where nothing else is said
  /// Moves along the path of `config` over the world's ground. Simulated bodies start at rest on it and are driven by
  /// their own controller; what comes out is where the vehicle's frame really went.
  /// @throws std::invalid_argument naming the field, or the place of the path that this vehicle cannot follow.
  Trajectory (*drive)(const MotionConfig& config, const World& world, const RayScene& rays,
                      std::uint64_t seed) = nullptr;
  /// Its looks in the vehicle's frame, for sensors that see it; nullptr: nothing is in view.
  SceneDescription (*body)() = nullptr;
};

const std::vector<VehicleInfo>& vehicle_library();

/// @throws std::invalid_argument listing what there is.
const VehicleInfo& vehicle_named(const std::string& name);

}  // namespace plumbline
