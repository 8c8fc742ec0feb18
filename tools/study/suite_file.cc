#include "tools/study/suite_file.h"

#include "scenarios/yaml_reader.h"

namespace plumbline {
namespace {

constexpr Range kEffect_percent{0.1, 1000.0};

/// Names stand in tables and file names.
bool is_plain(const std::string& name) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !name.empty() && name.size() <= 64 && name.find_first_not_of(kAllowed) == std::string::npos;
}

SuiteScenario read_entry(ConfigReader& scenarios, const std::string& name, const ConfigNode& node) {
  if (!is_plain(name)) fail_at(node, "scenarios", "names of letters, digits, _ and -");
  SuiteScenario scenario{name, {}, {}};
  if (!node.is_map()) {
    scenarios.read(name, scenario.path);
    return scenario;
  }
  scenarios.section(name, [&](ConfigReader& entry) {
    const bool has_scenario = entry.read("scenario", scenario.path);
    read_fixed(entry, scenario.fixed);
    entry.finish();
    if (!has_scenario) fail_at(node, entry.path_of("scenario"), "the scenario's file");
  });
  return scenario;
}

void read_effects(ConfigReader& reader, Effects& effects) {
  reader.section("effects_percent", [&](ConfigReader& section) {
    for (const RegressFigure& figure : regress_figures()) {
      double percent = 0.0;
      if (section.read(figure.key, percent, kEffect_percent)) effects.percent[figure.key] = percent;
    }
  });
}

}  // namespace

SuiteFile read_suite_file(const std::filesystem::path& path) {
  const ConfigNode file = read_yaml_file(path);
  SuiteFile suite;
  suite.name = path.stem().string();
  suite.path = path;
  ConfigReader reader(file, "");
  std::vector<std::string> fixed;
  read_fixed(reader, fixed);
  reader.section("scenarios", [&](ConfigReader& scenarios) {
    for (const auto& [name, node] : scenarios.node().entries) {
      suite.scenarios.push_back(read_entry(scenarios, name, node));
    }
  });
  read_seeds(reader, suite.seeds);
  read_limits(reader, suite.limits);
  read_effects(reader, suite.effects);
  reader.finish();
  if (suite.scenarios.empty()) fail_at(file, "scenarios", "at least one NAME: scenario's file");
  if (suite.seeds.size() < kLeastSuiteSeeds) {
    fail_at(file, "seeds", "at least " + std::to_string(kLeastSuiteSeeds) + ": fewer do not tell how much runs differ");
  }
  for (SuiteScenario& scenario : suite.scenarios) {
    scenario.fixed.insert(scenario.fixed.begin(), fixed.begin(), fixed.end());
  }
  return suite;
}

}  // namespace plumbline
