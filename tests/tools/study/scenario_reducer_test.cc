#include "tools/study/scenario_reducer.h"

#include <gtest/gtest.h>

#include "scenarios/yaml_reader.h"

namespace plumbline {
namespace {

constexpr const char* kScenario = R"(
seed: 3
world: {scene: corridor, light: {lux: 5, schedule: [{start_s: 2, factor: 0}]}}
motion: {speed_mps: 2, gait: {height_m: 0.1}, waypoints: [1, 2, 3, 4, 5, 6, 7, 8]}
rig: {pitch_deg: 10}
estimator: {name: vio}
)";

/// Fails whenever it is dark and there are three way-points or more.
bool fails(const ConfigNode& keys) {
  const auto world = keys.entries.find("world");
  const auto motion = keys.entries.find("motion");
  if (world == keys.entries.end() || motion == keys.entries.end()) return false;
  const auto light = world->second.entries.find("light");
  const auto points = motion->second.entries.find("waypoints");
  return light != world->second.entries.end() && light->second.entries.contains("schedule") &&
         points != motion->second.entries.end() && points->second.items.size() >= 3;
}

std::vector<bool> answers(const std::vector<ConfigNode>& candidates) {
  std::vector<bool> answers;
  for (const ConfigNode& candidate : candidates) answers.push_back(fails(candidate));
  return answers;
}

TEST(ScenarioReducer, LeavesOnlyWhatTheFailureNeeds) {
  const ConfigNode simplest = reduced(read_yaml_text(kScenario, "test", "."), 2, answers);
  EXPECT_EQ(flow_yaml(simplest),
            "{estimator: {name: vio}, motion: {waypoints: [1, 2, 3]}, seed: 3, world: {light: {schedule: [{factor: 0, "
            "start_s: 2}]}}}");
}

TEST(ScenarioReducer, IsTheSameHoweverManyAreTriedAtATime) {
  const ConfigNode keys = read_yaml_text(kScenario, "test", ".");
  const std::string one = canonical_yaml(reduced(keys, 1, answers));
  for (const std::size_t at_a_time : {2U, 5U}) EXPECT_EQ(canonical_yaml(reduced(keys, at_a_time, answers)), one);
}

TEST(ScenarioReducer, EndsWhereItIsInterrupted) {
  const ConfigNode keys = read_yaml_text(kScenario, "test", ".");
  const auto silent = [](const std::vector<ConfigNode>&) { return std::vector<bool>(); };
  EXPECT_EQ(canonical_yaml(reduced(keys, 2, silent)), canonical_yaml(keys));
}

}  // namespace
}  // namespace plumbline
