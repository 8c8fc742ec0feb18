#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/world.h"

namespace plumbline {

/// A number that a scenario may set under world.parameters.
struct SceneParameter {
  std::string name;  ///< with its unit, `length_m`
  double default_value = 0.0;
  double min = 0.0;
  double max = 0.0;
  std::string meaning;
  bool whole = false;  ///< only whole numbers make sense
};

inline constexpr double kLampLightLux = 200.0;
inline constexpr double kStreetLampLux = 20.0;
inline constexpr double kDaylightLux = 50'000.0;

using SceneValues = std::map<std::string, double>;

/// A procedural scene: the same values and seed give the same world, byte for byte.
struct SceneInfo {
  std::string name;
  std::string summary;
  std::vector<SceneParameter> parameters;
  /// `values` holds every parameter, defaults filled in and ranges checked.
  SceneDescription (*build)(const SceneValues& values, std::uint64_t world_seed) = nullptr;
  double usual_lux = kLampLightLux;  ///< the light level unless a scenario sets one, or the sun shines
};

const std::vector<SceneInfo>& scene_library();

/// @throws std::invalid_argument naming the scene or parameter, what was found and what is allowed.
SceneDescription build_scene(const std::string& name, const SceneValues& overrides, std::uint64_t world_seed);

}  // namespace plumbline
