#include "tools/study/suite_plan.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "scenarios/scenario.h"
#include "sim/random_stream.h"
#include "tools/output/provenance.h"

namespace plumbline {
namespace {

constexpr const char* kAxis = "scenario";

const SuiteScenario& named(const SuiteFile& suite, const std::string& name) {
  return *std::find_if(suite.scenarios.begin(), suite.scenarios.end(),
                       [&](const SuiteScenario& scenario) { return scenario.name == name; });
}

Scenario loaded(const SuiteFile& suite, const SuiteScenario& scenario, const std::string& estimator,
                std::uint64_t seed) {
  std::vector<std::string> overrides = scenario.fixed;
  if (!estimator.empty()) overrides.push_back("estimator.name=" + estimator);
  try {
    return load_scenario(scenario.path, overrides, seed);
  } catch (const InputError& error) {
    throw InputError(suite.path.string() + ": scenarios." + scenario.name + ": " + error.what());
  }
}

std::string four_digits(std::size_t number) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "%04zu", number);
  return text.data();
}

}  // namespace

SweepPlan suite_plan(const SuiteFile& suite, const std::string& estimator) {
  SweepPlan plan;
  plan.name = suite.name;
  plan.scenario = suite.name;
  plan.seeds = suite.seeds;
  plan.limits = suite.limits;
  plan.program = program_version();
  plan.axes = {{kAxis, false, {}, {}}};
  for (const SuiteScenario& scenario : suite.scenarios) {
    plan.axes.front().values.push_back({scenario.name, std::nullopt});
    for (const std::uint64_t seed : suite.seeds) {
      const Scenario run = loaded(suite, scenario, estimator, seed);
      plan.runs.push_back(
          {four_digits(plan.runs.size()), {{scenario.name, std::nullopt}}, run.estimator_name, seed, run.digest});
      if (std::find(plan.estimators.begin(), plan.estimators.end(), run.estimator_name) == plan.estimators.end()) {
        plan.estimators.push_back(run.estimator_name);
      }
    }
  }
  return plan;
}

bool is_suite_plan(const SweepPlan& plan) { return plan.axes.size() == 1 && plan.axes.front().key == kAxis; }

const std::string& suite_scenario_of(const PlannedRun& run) { return run.values.front().text; }

RunCommand suite_run(const SuiteFile& suite, const std::string& estimator, const std::string& program) {
  return [&suite, estimator, program](const PlannedRun& run, const std::filesystem::path& directory) {
    const SuiteScenario& scenario = named(suite, suite_scenario_of(run));
    std::vector<std::string> command{program,
                                     "run",
                                     std::filesystem::absolute(scenario.path).string(),
                                     "--seed",
                                     std::to_string(run.seed),
                                     "--threads",
                                     "1",
                                     "--out",
                                     directory.string()};
    if (!estimator.empty()) command.insert(command.end(), {"--estimator", estimator});
    for (const std::string& override : scenario.fixed) command.insert(command.end(), {"--set", override});
    return command;
  };
}

std::string suite_digest(const SuiteFile& suite) {
  std::string text = suite.name;
  for (const SuiteScenario& scenario : suite.scenarios) {
    text += "\n" + scenario.name;
    for (const std::uint64_t seed : suite.seeds) (text += ' ') += loaded(suite, scenario, {}, seed).digest;
  }
  std::array<char, 24> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(derive_seed(0, text)));
  return digits.data();
}

}  // namespace plumbline
