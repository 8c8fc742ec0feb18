#include "tools/mount/mount_results.h"

#include <gtest/gtest.h>

#include "tools/mount/mount_tables.h"

namespace plumbline {
namespace {

MountStudy study_of_tilts() {
  MountStudy study;
  study.name = "tilts";
  study.runs.axes = {{"rig.pitch_deg", false, {}, {}}};
  study.scenarios = {"walk.yaml"};
  study.judged = "vloam";
  study.runs.estimators = {"imu_lidar", "vloam"};
  return study;
}

AxisValue angle(int deg) { return {std::to_string(deg), deg}; }

Mounting mounting(int deg, double predicted_drift, double coverage = 0.5) {
  Mounting m;
  m.values = {angle(deg)};
  m.predicted.drift_percent = predicted_drift;
  m.predicted.coverage = coverage;
  return m;
}

RunRow run(int deg, std::uint64_t seed, double drift, const std::string& estimator = "vloam",
           const std::string& status = "ok") {
  RunRow row;
  row.run.values = {angle(deg)};
  row.run.seed = seed;
  row.run.estimator = estimator;
  row.status = status;
  row.figures = {{"drift_percent", std::to_string(drift)}, {"modules.lidar.degenerate_share", "0.25"}};
  return row;
}

TEST(MountResults, TryTheBestPredictedOrASpread) {
  MountStudy study = study_of_tilts();
  study.weights = {1.0, 0.0, 0.0, 0.0};
  study.trial.mountings = 2;
  std::vector<Mounting> mountings = {mounting(0, 3.0), mounting(30, 1.0), mounting(60, 2.0), mounting(90, 0.5)};
  mountings[3].ruled_out = "the vehicle takes up 80 % of the view";
  EXPECT_EQ(choose_for_trial(study, mountings), (std::vector<std::size_t>{1, 2}));
  study.trial.spread = true;
  EXPECT_EQ(choose_for_trial(study, mountings), (std::vector<std::size_t>{0, 1}));  // the best and the worst
  EXPECT_DOUBLE_EQ(mountings[1].predicted_cost, 0.0);
  EXPECT_DOUBLE_EQ(mountings[0].predicted_cost, 1.0);
}

TEST(MountResults, RecommendTheLeastCostAndSayWhy) {
  MountStudy study = study_of_tilts();
  study.weights = {1.0, 0.0, 0.0, 0.0};
  std::vector<Mounting> mountings = {mounting(0, 1.0), mounting(45, 2.0), mounting(90, 3.0), mounting(60, 2.5)};
  std::vector<RunRow> rows;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    rows.push_back(run(0, seed, 0.05 + 0.001 * static_cast<double>(seed)));
    rows.push_back(run(45, seed, 0.6));
    rows.push_back(run(90, seed, 1.4));
    rows.push_back(run(90, seed, 3.0, "imu_lidar", "lost"));
  }
  const MountResults results = conclude(study, mountings, {rows});
  ASSERT_EQ(results.recommended, 0u);
  const Mounting& best = results.mountings[0];
  EXPECT_NEAR(best.drift_percent->value, 0.0525, 1e-4);  // geometric over one scenario, median over seeds
  EXPECT_DOUBLE_EQ(best.degenerate_time, 0.25);
  EXPECT_TRUE(best.is_on_front);
  EXPECT_FALSE(results.mountings[1].is_on_front);
  EXPECT_FALSE(results.mountings[3].tried);
  EXPECT_DOUBLE_EQ(results.rank_correlation->value, 1.0);
  // A lost run counts as having drifted all of its way.
  EXPECT_NEAR(results.mountings[2].drift_of_others.at("imu_lidar").value, 100.0, 1e-9);
  const std::string reason = reason_for(study, results);
  EXPECT_NE(reason.find("rig.pitch_deg = 0"), std::string::npos) << reason;
  EXPECT_NE(reason.find("the least of all"), std::string::npos) << reason;
  EXPECT_NE(mountings_csv(study, results).find("\n90,"), std::string::npos);
}

TEST(MountResults, KeepOnTheFrontWhatIsBestInOneFigure) {
  MountStudy study = study_of_tilts();
  study.weights = {1.0, 0.0, 1.0, 0.0};
  std::vector<Mounting> mountings = {mounting(0, 1.0, 0.2), mounting(45, 2.0, 0.9), mounting(90, 3.0, 0.5)};
  choose_for_trial(study, mountings);
  EXPECT_TRUE(mountings[0].is_on_front);
  EXPECT_TRUE(mountings[1].is_on_front);
  EXPECT_FALSE(mountings[2].is_on_front);
}

TEST(MountResults, NameTheLimitThatIsBroken) {
  MountPrediction prediction;
  prediction.own_body_share = 0.3;
  prediction.overlap = 0.1;
  EXPECT_EQ(broken_limit(prediction, {0.2, 0.0}), "the vehicle takes up 30.0 % of the view");
  EXPECT_EQ(broken_limit(prediction, {0.5, 0.4}), "the lidar sees 10.0 % of the image");
  EXPECT_EQ(broken_limit(prediction, {0.5, 0.0}), "");
}

}  // namespace
}  // namespace plumbline
