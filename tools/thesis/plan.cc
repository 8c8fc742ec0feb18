#include "tools/thesis/plan.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "scenarios/scenario.h"
#include "scenarios/scenario_files.h"

namespace plumbline {
namespace {

/// "0.1.0 (7c7af71)" as part of a file's name: 0.1.0-7c7af71.
std::string file_name_of(const std::string& program) {
  std::string name;
  for (const char c : program) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.') {
      name += c;
    } else if (!name.empty() && name.back() != '-' && c != ')') {
      name += '-';
    }
  }
  return name;
}

constexpr const char* kNotOfTheSensors[] = {"estimator", "expect"};

/// All that the sensors depend on.
std::string sensors_of(ConfigNode keys, std::uint64_t seed) {
  for (const char* key : kNotOfTheSensors) keys.entries.erase(key);
  keys.entries.erase("seed");
  return std::to_string(seed) + "\n" + canonical_yaml(keys);
}

/// A replay does not know the world, and so not how far mapped points are from its surfaces.
bool needs_the_world(const Experiment& experiment) {
  return std::any_of(experiment.checks.begin(), experiment.checks.end(),
                     [](const ExperimentCheck& check) { return check.figure.starts_with("map_"); });
}

/// Runs of an experiment, each with the place where its sensors may be found.
class RunPlanner {
 public:
  explicit RunPlanner(const std::string& program) : program_(file_name_of(program)) {}

  ThesisRun plan(const Experiment& experiment, const Configuration& configuration, std::uint64_t seed) {
    ThesisRun run;
    run.label = experiment.id + " " + configuration.name + " seed " + std::to_string(seed);
    run.scenario = std::filesystem::absolute(experiment.scenario);
    run.overrides = configuration.overrides;
    if (!configuration.estimator.empty()) run.overrides.push_back("estimator.name=" + configuration.estimator);
    const Scenario scenario = load_scenario(experiment.scenario, run.overrides, seed);
    run.planned.estimator = scenario.estimator_name;
    run.planned.seed = seed;
    run.planned.scenario_digest = scenario.digest;
    run.planned.key = scenario.digest + "-" + std::to_string(seed) + "-" + program_;

    const ConfigNode keys = read_scenario_files(experiment.scenario, run.overrides);
    for (const char* key : kNotOfTheSensors) {
      const auto found = keys.entries.find(key);
      if (found != keys.entries.end()) run.replay_keys.push_back(std::string(key) + "=" + flow_yaml(found->second));
    }
    run.stream = needs_the_world(experiment) ? run.planned.key
                                             : streams_.emplace(sensors_of(keys, seed), run.planned.key).first->second;
    return run;
  }

 private:
  std::string program_;
  std::map<std::string, std::string> streams_;  ///< what sensors depend on -> key of the first run with them
};

}  // namespace

std::vector<ThesisRow> plan_thesis(const std::vector<Experiment>& experiments, const std::string& program) {
  std::vector<ThesisRow> rows;
  RunPlanner planner(program);
  for (const Experiment& experiment : experiments) {
    ThesisRow row{experiment, {}, {}};
    for (const Configuration& configuration : experiment.configurations) {
      std::vector<ThesisRun>& runs = row.runs.emplace_back();
      try {
        for (const std::uint64_t seed : experiment.seeds) {
          runs.push_back(planner.plan(experiment, configuration, seed));
        }
      } catch (const InputError& error) {
        runs.clear();
        row.impossible += (row.impossible.empty() ? "" : "; ") + configuration.name + ": " + error.what();
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace plumbline
