#include <algorithm>
#include <optional>

#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kLux{0.0, 100'000.0};
constexpr Range kLightFactor{0.0, 1000.0};
constexpr Range kSunLux{0.0, 200'000.0};
constexpr Range kRigLamp_cd{0.0, 1'000'000.0};
constexpr Range kPatches{0, 100};
constexpr Range kContrast{0.0, 3.0};
constexpr Range kVisibility_m{1.0, 1'000'000.0};
constexpr Range kRain_mm_per_h{0.0, 300.0};

std::vector<LightStep> read_schedule(const ConfigNode& node, const std::string& key) {
  std::vector<LightStep> schedule;
  for (const auto& item : list_of(node, key)) {
    LightStep step;
    ConfigReader reader(item, key);
    const bool has_start = reader.read("start_s", step.start_s, kRunTime_s);
    const bool has_factor = reader.read("factor", step.factor, kLightFactor);
    reader.finish();
    if (!has_start || !has_factor) fail_at(item, key, "both start_s and factor in every entry");
    if (!schedule.empty() && step.start_s <= schedule.back().start_s) {
      fail_at(item, key, "every start_s later than the one before it");
    }
    schedule.push_back(step);
  }
  return schedule;
}

void read_if_given(ConfigReader& reader, const char* key, std::optional<double>& value, Range range) {
  double given = 0.0;
  if (reader.read(key, given, range)) value = given;
}

void read_air(ConfigReader& reader, Atmosphere& air) {
  reader.section("fog", [&](ConfigReader& fog) { fog.read("visibility_m", air.fog_visibility_m, kVisibility_m); });
  reader.section("dust", [&](ConfigReader& dust) { dust.read("visibility_m", air.dust_visibility_m, kVisibility_m); });
  reader.section("rain", [&](ConfigReader& rain) { rain.read("mm_per_h", air.rain_mm_per_h, kRain_mm_per_h); });
}

void read_light(ConfigReader& reader, WorldConfig& config) {
  read_if_given(reader, "lux", config.light_lux, kLux);
  read_if_given(reader, "sun_lux", config.sun_lux, kSunLux);
  reader.read("night", config.night);
  reader.read("rig_lamp_cd", config.rig_lamp_cd, kRigLamp_cd);
  reader.read("glare_patches", config.glare_patches, kPatches);
  if (const ConfigNode* schedule = reader.find("schedule")) {
    config.light_schedule = read_schedule(*schedule, reader.path_of("schedule"));
  }
}

const SceneInfo& scene_named(const std::string& name, const ConfigNode& node, const std::string& key) {
  std::vector<std::string> names;
  for (const auto& scene : scene_library()) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  fail_at(node, key, "one of: " + joined(names));
}

void read_parameters(ConfigReader& reader, const SceneInfo& scene, SceneValues& values) {
  for (const auto& parameter : scene.parameters) {
    double value = parameter.default_value;
    if (reader.read(parameter.name, value, {parameter.min, parameter.max})) values[parameter.name] = value;
  }
}

}  // namespace

void read_world(ConfigReader& reader, WorldConfig& config) {
  std::uint64_t seed = 0;
  if (reader.read("seed", seed)) config.seed = seed;
  read_air(reader, config.atmosphere);
  reader.read("contrast", config.contrast, kContrast);

  // A user's own world takes the place of a scene that a base may have named.
  const ConfigNode* scene_node = reader.find("scene");
  reader.read("scene", config.scene);
  if (reader.read("mjcf", config.mjcf)) config.scene.clear();
  const ConfigNode& named = scene_node == nullptr ? reader.node() : *scene_node;
  const SceneInfo own_world{"mjcf", "", {}, nullptr};
  const SceneInfo& scene = config.scene.empty() ? own_world : scene_named(config.scene, named, reader.path_of("scene"));
  config.usual_lux = scene.usual_lux;
  reader.section("light", [&](ConfigReader& light) { read_light(light, config); });
  reader.section("parameters",
                 [&](ConfigReader& parameters) { read_parameters(parameters, scene, config.parameters); });
}

}  // namespace plumbline
