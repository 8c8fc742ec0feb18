#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"
#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

class SuiteTest : public ::testing::Test {
 protected:
  SuiteTest() { directory_.write("base.yaml", "motion:\n  waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]\n"); }

  SuiteFile read(const std::string& text) const { return read_suite_file(directory_.write("suite.yaml", text)); }
  std::string refusal(const std::string& text) const {
    try {
      suite_plan(read(text), {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryDirectory directory_;
};

constexpr const char* kSuite = R"(
scenarios:
  bright: base.yaml
  blind: {scenario: base.yaml, set: {world.light.lux: 0.01}}
set: {motion.rest_s: 1}
seeds: 3
effects_percent: {drift: 70}
)";

TEST_F(SuiteTest, EveryScenarioRunsOverEverySeed) {
  const SuiteFile suite = read(kSuite);
  EXPECT_EQ(suite.effects.percent.at("drift"), 70.0);
  const SweepPlan plan = suite_plan(suite, {});
  ASSERT_EQ(plan.runs.size(), 6U);
  EXPECT_EQ(suite_scenario_of(plan.runs[0]), "blind");
  EXPECT_EQ(plan.runs[5].key, "0005");
  EXPECT_TRUE(is_suite_plan(plan_of_json(plan_json(plan))));
  const auto command = suite_run(suite, "vio", "plumbline")(plan.runs[0], "out");
  EXPECT_THAT(command, ::testing::IsSupersetOf({"motion.rest_s=1", "world.light.lux=0.01", "--estimator", "vio"}));
}

TEST_F(SuiteTest, TheDigestIsTheScenariosAndSeeds) {
  const std::string digest = suite_digest(read(kSuite));
  std::string other(kSuite);
  EXPECT_EQ(suite_digest(read(other + "limits: {time_s: 9}\n")), digest);
  EXPECT_NE(suite_digest(read(other.replace(other.find("seeds: 3"), 8, "seeds: 4"))), digest);
  directory_.write("base.yaml", "motion:\n  waypoints: [[4, 4.75, 1.5], [23, 4.75, 1.5]]\n");
  EXPECT_NE(suite_digest(read(kSuite)), digest);
}

TEST_F(SuiteTest, RefusesWhatItCannotMean) {
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"seeds: 3", "at least one NAME"},
           {"scenarios: {a: base.yaml}", "at least 3"},
           {"scenarios: {a: base.yaml}\nseeds: 2", "at least 3"},
           {"scenarios: {a: nowhere.yaml}\nseeds: 3", "nowhere.yaml"},
           {"scenarios: {a/b: base.yaml}\nseeds: 3", "names of letters"},
           {"scenarios: {a: {set: {}}}\nseeds: 3", "the scenario's file"},
           {"scenarios: {a: {scenario: base.yaml, sets: {}}}\nseeds: 3", "unknown key"},
           {"scenarios: {a: base.yaml}\nseeds: 3\neffects_percent: {speed: 3}", "unknown key"},
           {"scenarios: {a: base.yaml}\nseeds: 3\nset: {world.light.luxx: 3}", "scenarios.a"},
           {"scenarios: [a]\nseeds: 3", "scenarios"}}) {
    EXPECT_THAT(refusal(text), HasSubstr(says)) << text;
  }
}

TEST(ShippedSuites, CoverWhatTheyShouldAndLoad) {
  const SuiteFile suite = read_suite_file(PLUMBLINE_SCENARIO_DIR "/suites/ci.yaml");
  std::vector<std::string> names;
  for (const SuiteScenario& scenario : suite.scenarios) names.push_back(scenario.name);
  EXPECT_EQ(names, (std::vector<std::string>{"aggressive", "corridor", "dark", "flat", "tunnel", "vegetated"}));
  EXPECT_EQ(suite_plan(suite, {}).runs.size(), 6 * suite.seeds.size());
  EXPECT_NO_THROW(suite_plan(read_suite_file(PLUMBLINE_SCENARIO_DIR "/suites/short.yaml"), {}));
}

}  // namespace
}  // namespace plumbline
