#include "tools/thesis/suite_plan.h"

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

bool is_of_estimator(const std::string& override) { return override.starts_with("estimator."); }

/// All that the sensors depend on.
std::string sensors_of(const Experiment& experiment, const SuiteRun& run) {
  ConfigNode keys = read_scenario_files(experiment.scenario, run.overrides);
  for (const char* key : {"estimator", "expect", "seed"}) keys.entries.erase(key);
  return std::to_string(run.planned.seed) + "\n" + canonical_yaml(keys);
}

SuiteRun run_of(const Experiment& experiment, const Configuration& configuration, std::uint64_t seed,
                const std::string& program) {
  SuiteRun run;
  run.label = experiment.id + " " + configuration.name + " seed " + std::to_string(seed);
  run.scenario = std::filesystem::absolute(experiment.scenario);
  for (const std::string& override : configuration.overrides) {
    (is_of_estimator(override) ? run.estimator_overrides : run.overrides).push_back(override);
  }
  if (!configuration.estimator.empty()) {
    run.estimator_overrides.push_back("estimator.name=" + configuration.estimator);
  }
  std::vector<std::string> all = run.overrides;
  all.insert(all.end(), run.estimator_overrides.begin(), run.estimator_overrides.end());
  const Scenario scenario = load_scenario(experiment.scenario, all, seed);
  run.planned.estimator = scenario.estimator_name;
  run.planned.seed = seed;
  run.planned.scenario_digest = scenario.digest;
  run.planned.key = scenario.digest + "-" + std::to_string(seed) + "-" + program;
  return run;
}

}  // namespace

std::vector<SuiteRow> plan_suite(const std::vector<Experiment>& experiments, const std::string& program) {
  std::vector<SuiteRow> rows;
  std::map<std::string, std::string> streams;  // what the sensors depend on -> key of the first run with it
  for (const Experiment& experiment : experiments) {
    SuiteRow row{experiment, {}, {}};
    for (const Configuration& configuration : experiment.configurations) {
      std::vector<SuiteRun>& runs = row.runs.emplace_back();
      try {
        for (const std::uint64_t seed : experiment.seeds) {
          runs.push_back(run_of(experiment, configuration, seed, file_name_of(program)));
          SuiteRun& run = runs.back();
          run.stream = streams.emplace(sensors_of(experiment, run), run.planned.key).first->second;
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
