#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenarios/scenario.h"
#include "scenarios/scenario_files.h"
#include "tests/scenarios/body_trajectory.h"
#include "tools/thesis/results.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

const fs::path kThesis = fs::path(PLUMBLINE_SCENARIO_DIR) / "thesis";

std::vector<fs::path> thesis_scenarios() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kThesis)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".yaml" && path.stem() != "experiments") paths.push_back(path);
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool is_switch(const std::string& section, const std::string& key) {
  return key == "enabled" || (section == "degeneracy" && key == "remapping");
}

TEST(ThesisScenarios, LoadAndSetNoSettingOfTheEstimator) {
  EXPECT_GE(thesis_scenarios().size(), 20U);
  for (const fs::path& path : thesis_scenarios()) {
    SCOPED_TRACE(path.filename());
    EXPECT_NO_THROW(load_scenario(path, {}, {}));
    const ConfigNode keys = read_scenario_files(path, {});
    const auto estimator = keys.entries.find("estimator");
    if (estimator == keys.entries.end()) continue;
    for (const auto& [section, below] : estimator->second.entries) {
      if (section == "name") continue;
      ASSERT_TRUE(below.is_map()) << section;
      for (const auto& [key, value] : below.entries) EXPECT_TRUE(is_switch(section, key)) << section << '.' << key;
    }
  }
}

/// A file may load and yet ask for a way that is too short or turns too tightly for its vehicle. Where a flight in
/// closed loop will go is not known; the truth can fly the same way.
TEST(ThesisScenarios, HaveWaysThatTheirVehiclesCanGo) {
  std::vector<fs::path> paths = thesis_scenarios();
  paths.push_back(kThesis.parent_path() / "tilt_walk.yaml");
  for (const fs::path& path : paths) {
    SCOPED_TRACE(path.filename());
    const Scenario scenario = load_scenario(path, {"motion.closed_loop.enabled=false"}, {});
    const std::string& scene = scenario.world.scene;
    if (scene == "street" || scene == "campus" || scene == "highway") continue;  // kilometres take minutes to drive
    EXPECT_GT(body_trajectory(scenario).end_ns(), 10'000'000'000);
  }
}

TEST(ThesisExperiments, NameScenariosThatAreThere) {
  const std::vector<Experiment> experiments = read_experiments(kThesis / "experiments.yaml");
  EXPECT_GE(experiments.size(), 20U);
  std::set<fs::path> used;
  for (const Experiment& experiment : experiments) {
    SCOPED_TRACE(experiment.id);
    used.insert(fs::weakly_canonical(experiment.scenario));
    const Scenario scenario = load_scenario(experiment.scenario, {}, {});
    if (scenario.survey) used.insert(fs::weakly_canonical(*scenario.survey));
    EXPECT_GE(experiment.seeds.size(), experiment.simulated_s < 180.0 ? 10U : 3U);
  }
  for (const fs::path& path : thesis_scenarios()) {
    EXPECT_TRUE(used.contains(fs::weakly_canonical(path))) << path << " stands in no row";
  }
}

/// Two tables of the thesis are about what fewer features and coarser maps cost.
bool is_traded_off(const std::string& key) {
  return key == "estimator.vision.feature_share" || key == "estimator.lidar.resolution_factor";
}

TEST(ThesisExperiments, ChangeTheEstimatorByItsSwitchesAlone) {
  for (const Experiment& experiment : read_experiments(kThesis / "experiments.yaml")) {
    for (const Configuration& configuration : experiment.configurations) {
      for (const std::string& override : configuration.overrides) {
        if (!override.starts_with("estimator.")) continue;
        const std::string key = override.substr(0, override.find('='));
        EXPECT_TRUE(key.ends_with(".enabled") || key == "estimator.degeneracy.remapping" || is_traded_off(key))
            << experiment.id << " " << configuration.name << ": " << key;
      }
    }
  }
}

TEST(ThesisExperiments, ResultsHoldARowForEach) {
  const std::vector<RowResult> results = read_results(kThesis / "results.json");
  std::set<std::string> ids;
  for (const RowResult& row : results) ids.insert(row.id);
  for (const Experiment& experiment : read_experiments(kThesis / "experiments.yaml")) {
    EXPECT_TRUE(ids.contains(experiment.id))
        << experiment.id << ": write results.json anew with tools/dev thesis --list";
  }
}

}  // namespace
}  // namespace plumbline
