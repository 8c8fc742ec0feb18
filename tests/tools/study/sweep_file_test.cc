#include "tools/study/sweep_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

constexpr const char* kBaseScenario = R"(
motion:
  waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]
)";

class SweepFileTest : public ::testing::Test {
 protected:
  SweepFileTest() { directory_.write("base.yaml", kBaseScenario); }

  SweepFile read(const std::string& text) const {
    return read_sweep_file(directory_.write("sweep.yaml", "scenario: base.yaml\n" + text));
  }
  std::string refusal(const std::string& text) const {
    try {
      make_plan(read(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryDirectory directory_;
};

std::vector<double> numbers(const SweepAxis& axis) {
  std::vector<double> numbers;
  for (const AxisValue& value : axis.values) numbers.push_back(*value.number);
  return numbers;
}

TEST_F(SweepFileTest, SpreadsRangesAsTheySay) {
  const SweepFile sweep = read(R"(
axes:
  motion.speed_mps: {range: [0.5, 2], step: 0.5}
  motion.speed_factor: {range: [1, 2], count: 3}
  world.light.lux: {log_range: [0.1, 1000], count: 5}
  estimator.lidar.enabled: [true, false]
)");
  ASSERT_EQ(sweep.axes.size(), 4U);
  EXPECT_EQ(sweep.axes[0].key, "estimator.lidar.enabled");
  EXPECT_FALSE(sweep.axes[0].is_numeric());
  EXPECT_EQ(numbers(sweep.axes[1]), (std::vector<double>{1.0, 1.5, 2.0}));
  EXPECT_EQ(numbers(sweep.axes[2]), (std::vector<double>{0.5, 1.0, 1.5, 2.0}));
  EXPECT_EQ(numbers(sweep.axes[3]), (std::vector<double>{0.1, 1.0, 10.0, 100.0, 1000.0}));
}

TEST_F(SweepFileTest, RefusesWhatItCannotMean) {
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"axis: {}", "unknown key, did you mean 'axes'"},
           {"axes: {}", "axes: found a map of keys, expected at least one"},
           {"axes: {world.light.lux: []}", "at least one value"},
           {"axes: {world.light.lux: [1, 2, 1.0]}", "each value once"},
           {"axes: {world.light.lux: {range: [1, 2]}}", "either count or step"},
           {"axes: {world.light.lux: {range: [2, 1], count: 3}}", "the smaller bound first"},
           {"axes: {world.light.lux: {log_range: [0, 1], count: 3}}", "expected a number"},
           {"axes: {world.light.lux: 5}", "a list of values"},
           {"axes: {seed: [1, 2]}", "seeds under `seeds`"},
           {"seeds: [3, 3]", "each seed once"},
           {"estimators: []", "at least one name"},
           {"sample: {sobol: 4}\naxes: {world.light.lux: [1, 2]}", "a range for `sample`"},
           {"sample: {sobol: 4}\naxes: {world.light.lux: {range: [1, 2], count: 2}}", "neither count nor step"},
           {"limits: {time_s: 0}", "limits.time_s"},
           {"find_boundary: world.light.lux", "the key of one of the axes"},
           {"axes: {world.light.lux: [1, 2]}\nset: {world.light.lux: 3}", "a key that is no axis"}}) {
    EXPECT_THAT(refusal(text), HasSubstr(says)) << text;
  }
}

TEST_F(SweepFileTest, RefusesWhatTheScenarioRefusesAndNamesTheRun) {
  EXPECT_THAT(refusal("axes: {world.light.luxx: [1]}"), HasSubstr("unknown key"));
  EXPECT_THAT(refusal("axes: {world.light.lux: [1, -5]}"), HasSubstr("world.light.lux = -5"));
  EXPECT_THAT(refusal("estimators: [vloam, valom]"), HasSubstr("valom"));
}

TEST_F(SweepFileTest, TheOrderInTheFileChangesNothing) {
  const std::string one = plan_json(make_plan(read(R"(
seeds: [1, 2]
estimators: [vio, vloam]
axes: {world.light.lux: [10, 200], motion.speed_factor: [2, 1]}
)")));
  const std::string other = plan_json(make_plan(read(R"(
axes: {motion.speed_factor: [1, 2], world.light.lux: [200, 10]}
estimators: [vloam, vio]
seeds: [2, 1]
)")));
  EXPECT_EQ(one, other);
  EXPECT_EQ(plan_json(plan_of_json(one)), one);
}

TEST_F(SweepFileTest, ASampleIsCrossedWithLists) {
  const SweepPlan plan = make_plan(read(R"(
sample: {latin_hypercube: 6}
axes:
  world.light.lux: {log_range: [1, 1000]}
  motion.speed_factor: [1, 2]
)"));
  EXPECT_EQ(plan.runs.size(), 12U);
  EXPECT_EQ(plan.runs.front().key, "0000");
  for (const PlannedRun& run : plan.runs) {
    EXPECT_GE(*run.values[1].number, 1.0);
    EXPECT_LE(*run.values[1].number, 1000.0);
  }
}

TEST_F(SweepFileTest, SaysWhatTwoPlansDifferIn) {
  const std::string plan = plan_json(make_plan(read("seeds: 2")));
  EXPECT_EQ(plan_difference(plan, plan), "");
  EXPECT_THAT(plan_difference(plan, plan_json(make_plan(read("seeds: 3")))), HasSubstr("seeds"));
  directory_.write("base.yaml", std::string(kBaseScenario) + "world: {light: {lux: 5}}\n");
  EXPECT_THAT(plan_difference(plan, plan_json(make_plan(read("seeds: 2")))), HasSubstr("scenario itself"));
}

}  // namespace
}  // namespace plumbline
