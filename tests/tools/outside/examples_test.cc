#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/tools/program_fixture.h"
#include "tools/formats/tum.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// The program itself, with the shipped examples and with things that are no estimators, over a metre.
class OutsideExamples : public ProgramFixture {
 protected:
  OutsideExamples() { directory_.write("base.yaml", kShortScenario); }
};

TEST_F(OutsideExamples, TakePartInASweepLikeOurOwn) {
  fs::copy_file(PLUMBLINE_EXAMPLE_LIBRARY, directory_.path() / "libmine.so");
  fs::copy_file(PLUMBLINE_EXAMPLE_PROGRAM, directory_.path() / "mine");
  fs::copy_file(PLUMBLINE_EXAMPLE_PYTHON, directory_.path() / "mine.py");
  directory_.write("sweep.yaml",
                   "scenario: base.yaml\n"
                   "estimators: [./libmine.so, exec:./mine, exec:" PLUMBLINE_PYTHON " mine.py, exec:/bin/false]\n");
  ASSERT_EQ(call("sweep sweep.yaml --out sweep --jobs 1"), 0) << content("said.txt");

  // In the order of their names: the library, the program, then /bin/false, the script.
  const auto library = read_tum(directory_.path() / "sweep/runs/0000/estimate.tum");
  const auto truth = read_tum(directory_.path() / "sweep/runs/0000/ground_truth.tum");
  ASSERT_EQ(library.size(), truth.size());
  // Three sigma of the accelerometer's turn-on bias, 0.6 m/s^2, which nobody estimates, over three seconds.
  const Eigen::Vector3d moved = truth.back().pose.translation - truth.front().pose.translation;
  EXPECT_NEAR(library.back().pose.translation.norm(), moved.norm(), 2.7);
  EXPECT_GT(library.back().pose.translation.norm(), 0.1);
  for (const std::string run : {"0001", "0003"}) {
    const auto other = read_tum(directory_.path() / "sweep/runs" / run / "estimate.tum");
    ASSERT_EQ(other.size(), library.size()) << run;
    // The same arithmetic, rounded in another order.
    EXPECT_LT(other.back().pose.local(library.back().pose).norm(), 1e-6) << run;
  }
  const std::string table = content("sweep/table.csv");
  EXPECT_THAT(table, HasSubstr("exec:/bin/false, at the message stamped"));
  EXPECT_THAT(table, HasSubstr("ended with exit code 1"));
}

TEST_F(OutsideExamples, AFailureIsRecordedWithAllFiles) {
  EXPECT_EQ(call("run base.yaml --estimator exec:/bin/false --out failed"), 3);
  EXPECT_THAT(content("failed/result.json"), HasSubstr("\"status\": \"error\""));
  EXPECT_THAT(content("failed/result.json"), HasSubstr("ended with exit code 1"));
  for (const char* name : {"ground_truth.tum", "estimate.tum", "map.ply", "degeneracy.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(directory_.path() / "failed" / name)) << name;
  }
}

TEST_F(OutsideExamples, WhatIsNoEstimatorIsBadInput) {
  directory_.write("notes.so", "not a library");
  EXPECT_EQ(call("run base.yaml --estimator ./notes.so --out bad"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("no estimator library"));
  EXPECT_EQ(call("run base.yaml --estimator ./nothing.so --out bad"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("estimator.name: found './nothing.so', expected an existing file"));
  EXPECT_EQ(call("run base.yaml --estimator exec:./nothing --out bad"), 2);
  EXPECT_EQ(call("run base.yaml --estimator exec: --out bad"), 2);
  EXPECT_EQ(call("run base.yaml --estimator exec:no-such-program-anywhere --out bad"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("cannot be executed"));
  EXPECT_EQ(call("run base.yaml --estimator exec:/bin/false --set estimator.vision.enabled=false --out bad"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("no settings"));
  EXPECT_FALSE(fs::exists(directory_.path() / "bad"));
}

}  // namespace
}  // namespace plumbline
