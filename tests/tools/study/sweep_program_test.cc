#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// The program itself, on a sweep of two runs of a metre each.
class SweepProgram : public ::testing::Test {
 protected:
  SweepProgram() {
    directory_.write("base.yaml",
                     "world: {scene: garage}\n"
                     "motion: {rest_s: 0.5, smoothing_s: 0.5, waypoints: [[6, 4.75, 1.5], [7, 4.75, 1.5]]}\n");
    directory_.write("sweep.yaml", "scenario: base.yaml\nestimators: [imu, vio]\n");
  }

  int call(const std::string& arguments) const {
    const std::string command =
        "cd '" + directory_.path().string() + "' && " PLUMBLINE_PROGRAM " " + arguments + " >said.txt 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  std::string content(const std::string& name) const {
    std::ifstream file(directory_.path() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryDirectory directory_;
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

}  // namespace
}  // namespace plumbline
