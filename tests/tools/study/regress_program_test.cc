#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/program_fixture.h"
#include "tests/tools/study/synthetic_suite.h"
#include "tools/study/baseline.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// The program itself, on a suite of five runs of less than a metre.
class RegressProgram : public ProgramFixture {
 protected:
  RegressProgram() {
    directory_.write("base.yaml", kShortScenario);
    directory_.write("suite.yaml", "scenarios: {garage: base.yaml}\nseeds: 5\n");
  }
  std::string write_baseline(const Baseline& baseline) {
    directory_.write("altered.json", baseline_json(baseline));
    return "altered.json";
  }
};

TEST_F(RegressProgram, UpdatesComparesAndFails) {
  const std::string common = "regress suite.yaml --out out --estimator imu --baseline ";
  ASSERT_EQ(call(common + "base.json --update"), 0) << content("said.txt");
  const Baseline baseline = read_baseline(directory_.path() / "base.json");
  ASSERT_EQ(baseline.runs.size(), 5U);
  EXPECT_FALSE(baseline.runs[0].relative_error_by_second_m.empty());

  // The runs are there already: the same bytes come out, and nothing fails.
  ASSERT_EQ(call(common + "base.json --junit report/junit.xml"), 2) << content("said.txt");
  ASSERT_EQ(call(common + "base.json --junit junit.xml"), 0) << content("said.txt");
  EXPECT_NE(content("junit.xml").find("failures=\"0\""), std::string::npos);
  EXPECT_NE(content("out/regress.md").find("shows no regression"), std::string::npos);
  EXPECT_NE(content("out/regress.html").find("runs/0004/report.html"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory_.path() / "out/runs/0004/report.html"));
  EXPECT_TRUE(fs::exists(directory_.path() / "out/table.csv"));

  // Against a past in which the errors were two thirds of what they are.
  Baseline better = baseline;
  for (MeasuredRun& run : better.runs) testing::worsen(run, 1.0 / 1.5);
  EXPECT_EQ(call(common + write_baseline(better) + " --junit junit.xml"), 1);
  EXPECT_NE(content("said.txt").find("1 s relative error grew by +50"), std::string::npos) << content("said.txt");
  EXPECT_NE(content("junit.xml").find("<failure"), std::string::npos);

  // Another suite's baseline, and one that was cut short, are refused before anything runs.
  directory_.write("suite.yaml", "scenarios: {garage: base.yaml}\nseeds: 4\n");
  EXPECT_EQ(call("regress suite.yaml --out other --baseline base.json"), 2);
  EXPECT_NE(content("said.txt").find("baseline of another suite"), std::string::npos);
  directory_.write("cut.json", content("base.json").substr(0, 300));
  EXPECT_EQ(call("regress suite.yaml --out other --baseline cut.json"), 2);
  EXPECT_NE(content("said.txt").find("cut short"), std::string::npos);
  EXPECT_EQ(call("regress suite.yaml --out other --baseline nowhere.json"), 2);
  EXPECT_FALSE(fs::exists(directory_.path() / "other"));
  // An ordinary sweep's directory is nobody's to overwrite.
  directory_.write("sweep.yaml", "scenario: base.yaml\n");
  ASSERT_EQ(call("sweep sweep.yaml --out sweep --shard 2/2"), 0) << content("said.txt");
  EXPECT_EQ(call("regress suite.yaml --out sweep --baseline new.json --update"), 2);
  EXPECT_NE(content("said.txt").find("holds another sweep"), std::string::npos);
}

TEST_F(RegressProgram, InterruptedItSaysHowToGoOn) {
  directory_.write("suite.yaml", "scenarios: {garage: base.yaml}\nseeds: 40\n");
  EXPECT_EQ(interrupted_call("regress suite.yaml --out out --baseline base.json --update --jobs 1", "out/runs/0000"),
            130);
  EXPECT_NE(content("said.txt").find("the same command goes on"), std::string::npos) << content("said.txt");
  EXPECT_FALSE(fs::exists(directory_.path() / "base.json"));
}

}  // namespace
}  // namespace plumbline
