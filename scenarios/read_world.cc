#include <algorithm>

#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kLux{0.001, 100'000.0};
constexpr Range kLightFactor{0.0, 1000.0};
constexpr Range kTime_s{0.0, 100'000.0};

std::vector<LightStep> read_schedule(const ConfigNode& node, const std::string& key) {
  std::vector<LightStep> schedule;
  for (const auto& item : list_of(node, key)) {
    LightStep step;
    ConfigReader reader(item, key);
    const bool has_start = reader.read("start_s", step.start_s, kTime_s);
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

void read_light(ConfigReader& reader, WorldConfig& config) {
  reader.read("lux", config.light_lux, kLux);
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
  // A user's own world takes the place of a scene that a base may have named.
  const ConfigNode* scene_node = reader.find("scene");
  reader.read("scene", config.scene);
  if (reader.read("mjcf", config.mjcf)) config.scene.clear();
  const ConfigNode& named = scene_node == nullptr ? reader.node() : *scene_node;
  const SceneInfo own_world{"mjcf", "", {}, nullptr};
  const SceneInfo& scene = config.scene.empty() ? own_world : scene_named(config.scene, named, reader.path_of("scene"));
  config.light_lux = scene.usual_lux;
  reader.section("light", [&](ConfigReader& light) { read_light(light, config); });
  reader.section("parameters",
                 [&](ConfigReader& parameters) { read_parameters(parameters, scene, config.parameters); });
}

}  // namespace plumbline
