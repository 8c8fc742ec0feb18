#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/program_fixture.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// The program itself, on a sweep of two runs of a metre each.
class SweepProgram : public ProgramFixture {
 protected:
  SweepProgram() {
    directory_.write("base.yaml", kShortScenario);
    directory_.write("sweep.yaml", "scenario: base.yaml\nestimators: [imu, vio]\n");
  }
};

TEST_F(SweepProgram, SweepsMergesAndReports) {
  ASSERT_EQ(call("sweep sweep.yaml --out a --shard 1/2"), 0) << content("said.txt");
  ASSERT_EQ(call("sweep sweep.yaml --out b --shard 2/2"), 0) << content("said.txt");
  ASSERT_EQ(call("merge b a --out whole"), 0) << content("said.txt");
  const std::string table = content("whole/table.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_NE(table.find("0000,imu,1,"), std::string::npos);
  EXPECT_EQ(table.find("_ms"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory_.path() / "whole/runs/0001/report.html"));

  // Nothing is left to do, and what is remade is the same.
  ASSERT_EQ(call("sweep sweep.yaml --out whole --resume"), 0) << content("said.txt");
  EXPECT_EQ(content("whole/table.csv"), table);
  fs::remove(directory_.path() / "whole/report.html");
  ASSERT_EQ(call("report whole"), 0) << content("said.txt");
  EXPECT_NE(content("whole/report.html").find("runs/0001/report.html"), std::string::npos);
}

TEST_F(SweepProgram, BadInputStartsNothing) {
  directory_.write("bad.yaml", "scenario: base.yaml\naxes: {world.light.lux: [1, bright]}\n");
  EXPECT_EQ(call("sweep bad.yaml --out bad"), 2);
  EXPECT_NE(content("said.txt").find("found 'bright'"), std::string::npos);
  EXPECT_FALSE(fs::exists(directory_.path() / "bad"));
  EXPECT_EQ(call("sweep sweep.yaml --out c --shard 0/2"), 2);
  EXPECT_EQ(call("merge nowhere --out c"), 2);
}

TEST_F(SweepProgram, InterruptedItSaysHowToGoOn) {
  directory_.write("long.yaml", "scenario: base.yaml\nestimators: [imu]\nseeds: 40\n");
  EXPECT_EQ(interrupted_call("sweep long.yaml --out d --jobs 1", "d/runs/0000"), 130);
  EXPECT_NE(content("said.txt").find("what has finished is kept, the same command with --resume goes on"),
            std::string::npos)
      << content("said.txt");
  EXPECT_TRUE(fs::exists(directory_.path() / "d/table.csv"));
}

TEST_F(SweepProgram, APlaceThatCannotBeWrittenToIsNamedOnce) {
  // Whoever we are, nothing can be made there.
  EXPECT_EQ(call("sweep sweep.yaml --out /proc/plumbline"), 2);
  const std::string said = content("said.txt");
  EXPECT_NE(said.find("--out /proc/plumbline: cannot be created"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

}  // namespace
}  // namespace plumbline
