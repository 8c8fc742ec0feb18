#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/tools/program_fixture.h"
#include "tools/evaluation/pairing.h"
#include "tools/formats/tum.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// The program itself, on two metres of a garage.
class ReplayProgram : public ProgramFixture {
 protected:
  ReplayProgram() {
    directory_.write("walk.yaml",
                     "world: {scene: garage}\n"
                     "motion: {rest_s: 1, smoothing_s: 0.5, waypoints: [[6, 4.75, 1.5], [8, 4.75, 1.5]]}\n"
                     "rig: {camera: {rate_hz: 20, width: 160, height: 120}}\n");
  }

  double worst_difference_m(const std::string& one, const std::string& other) const {
    const auto pairs = pair_poses(read_tum(directory_.path() / one / "estimate.tum"),
                                  read_tum(directory_.path() / other / "estimate.tum"));
    double worst_m = pairs.empty() ? INFINITY : 0.0;
    for (const auto& pair : pairs) {
      worst_m = std::max(worst_m, (pair.truth.translation - pair.estimate.translation).norm());
    }
    return worst_m;
  }
  /// How a replay of an export differs from the direct run.
  double difference_by(const std::string& format) const {
    EXPECT_EQ(call("export walk.yaml --format " + format + " --out data"), 0) << content("said.txt");
    EXPECT_EQ(call("replay data --format " + format + " --out replayed"), 0) << content("said.txt");
    return worst_difference_m("direct", "replayed");
  }
};

TEST_F(ReplayProgram, ReplayingAnExportGivesTheDirectRun) {
  ASSERT_EQ(call("run walk.yaml --out direct"), 0) << content("said.txt");
  EXPECT_LT(difference_by("plumbline"), 1e-6);
  // The same messages up to the rounding of point times to float32 seconds.
  EXPECT_LT(difference_by("kitti"), 0.01);
  EXPECT_LT(difference_by("rosbag2"), 0.01);

  const auto result = nlohmann::json::parse(content("replayed/result.json"));
  EXPECT_LT(result["drift_percent"].get<double>(), 5.0);
  EXPECT_TRUE(result["map_rmse_m"].is_null());
  EXPECT_TRUE(fs::exists(directory_.path() / "replayed/report.html"));

  // Without truth there is nothing to compare with.
  ASSERT_EQ(call("export walk.yaml --format kitti --out data"), 0) << content("said.txt");
  fs::remove(directory_.path() / "data/poses.txt");
  ASSERT_EQ(call("replay data --format kitti --estimator imu --out replayed"), 0) << content("said.txt");
  const auto blind = nlohmann::json::parse(content("replayed/result.json"));
  EXPECT_TRUE(blind["drift_percent"].is_null());
  EXPECT_TRUE(blind["distance_m"].is_null());
  EXPECT_EQ(blind["status"], "ok");
}

TEST_F(ReplayProgram, BadInputStartsNothing) {
  EXPECT_EQ(call("replay nowhere --format kitti --out out"), 2);
  EXPECT_EQ(call("replay . --format flux --out out"), 2);
  EXPECT_EQ(call("replay . --format kitti --set dataset.clock=3 --out out"), 2);
  EXPECT_NE(content("said.txt").find("clock_hz"), std::string::npos);
  EXPECT_EQ(call("export nothing.yaml --format kitti --out out"), 2);
  EXPECT_FALSE(fs::exists(directory_.path() / "out"));
}

}  // namespace
}  // namespace plumbline
