#include "tools/lab/threshold_calibration.h"

#include <gtest/gtest.h>

#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

TEST(ThresholdCalibration, PutsTheThresholdMidwayThroughTheMargin) {
  std::vector<LabelledSolve> solves(50, {100.0, true});
  solves.insert(solves.end(), 50, {250'000.0, false});
  const ModuleThreshold found = calibrate_threshold("lidar", solves);
  EXPECT_NEAR(*found.threshold, 5000.0, 1e-6);  // sqrt(100 * 250,000)
  EXPECT_TRUE(found.is_clear());
  EXPECT_EQ(found.degenerate, 50u);
}

TEST(ThresholdCalibration, SaysWhenThereIsNoMarginOrNothingToGoBy) {
  EXPECT_FALSE(calibrate_threshold("lidar", {{100.0, true}, {50.0, false}}).is_clear());
  const ModuleThreshold one_sided = calibrate_threshold("vision", {{50.0, false}});
  EXPECT_FALSE(one_sided.threshold);
  EXPECT_NE(thresholds_yaml("sweep", {one_sided}).find("threshold: null"), std::string::npos);
}

TEST(ThresholdCalibration, JoinsSolvesAndLabelsByStampAndModule) {
  const TemporaryDirectory directory;
  directory.write("degeneracy.csv",
                  "stamp_ns,module,mode,lambda_1,lambda_2\n"
                  "100,lidar,solved,7,9\n100,vision,solved,70,90\n200,lidar,partial,8,9\n300,lidar,solved,9,9\n");
  directory.write("truth_degeneracy.csv",
                  "stamp_ns,module,features,degenerate,excess_1\n"
                  "100,lidar,10,0,0.1\n100,vision,10,1,5\n200,lidar,10,1,1.2\n");
  const auto lidar = labelled_solves(directory.path(), "lidar");
  ASSERT_EQ(lidar.size(), 1u);  // 200 is grey, 300 has no label
  EXPECT_DOUBLE_EQ(lidar[0].least_eigenvalue, 7.0);
  EXPECT_FALSE(lidar[0].degenerate);
  const auto vision = labelled_solves(directory.path(), "vision");
  ASSERT_EQ(vision.size(), 1u);
  EXPECT_TRUE(vision[0].degenerate);
  EXPECT_TRUE(labelled_solves(directory.path() / "nowhere", "lidar").empty());
}

}  // namespace
}  // namespace plumbline
