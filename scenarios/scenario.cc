#include "scenarios/scenario.h"

#include "scenarios/digest.h"
#include "scenarios/read_sensor_errors.h"
#include "scenarios/scenario_files.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

ConfigNode seed_node(std::uint64_t seed) {
  ConfigNode node;
  node.text = std::to_string(seed);
  node.where = "--seed";
  return node;
}

void read_scenario(ConfigReader& reader, Scenario& scenario) {
  static const ConfigNode kNoKeys = [] {
    ConfigNode node;
    node.kind = ConfigNode::Kind::kMap;
    return node;
  }();
  reader.read("seed", scenario.seed);
  reader.section("world", [&](ConfigReader& world) { read_world(world, scenario.world); });
  const bool has_motion = reader.section("motion", [&](ConfigReader& motion) { read_motion(motion, scenario.motion); });
  if (!has_motion) fail_at(reader.node(), "motion", "a section motion with way-points");
  if (!reader.section("rig", [&](ConfigReader& rig) { read_rig(rig, scenario.seed, scenario.rig); })) {
    ConfigReader nothing(kNoKeys, "rig");
    read_rig(nothing, scenario.seed, scenario.rig);
  }
  if (const ConfigNode* faults = reader.find("faults")) read_faults(*faults, "faults", scenario.faults);
  reader.section("estimator", [&](ConfigReader& estimator) {
    read_estimator(estimator, scenario.estimator_name, scenario.estimator_directory, scenario.estimator);
  });
  reader.section("localization", [&](ConfigReader& localization) {
    std::filesystem::path survey;
    if (localization.read("survey", survey)) scenario.survey = survey;
  });
  reader.section("expect", [&](ConfigReader& expect) { read_expect(expect, scenario.expect, scenario.expect_status); });
  reader.finish();
}

}  // namespace

std::string digest_of(const std::string& text) {
  // FNV-1a, 64 bits.
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

Scenario load_scenario(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                       std::optional<std::uint64_t> seed) {
  ConfigNode keys = read_scenario_files(path, overrides);
  if (seed) keys.entries.insert_or_assign("seed", seed_node(*seed));
  Scenario scenario;
  scenario.name = path.stem().string();
  scenario.path = path;
  ConfigReader reader(keys, "");
  read_scenario(reader, scenario);
  keys.entries.insert_or_assign("seed", seed_node(scenario.seed));
  scenario.resolved_yaml = canonical_yaml(keys);
  scenario.digest = digest_of(scenario.resolved_yaml);
  return scenario;
}

}  // namespace plumbline
