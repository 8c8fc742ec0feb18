#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/synthetic_record.h"
#include "tools/output/result_json.h"
#include "tools/output/run_tables.h"

namespace plumbline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

nlohmann::json result_of(const RunRecord& record) {
  Scenario scenario;
  scenario.name = "corridor";
  const RunFigures figures = run_figures(record, [](const Eigen::Vector3d&) { return 0.02; });
  return nlohmann::json::parse(
      result_json(figures, judge(scenario, record, figures), record, make_provenance(scenario, 2)));
}

void expect_design_keys(const nlohmann::json& result) {
  for (const char* key : {"schema_version",
                          "status",
                          "distance_m",
                          "duration_s",
                          "drift_percent",
                          "progress_ratio",
                          "progress_ratio_worst_5s",
                          "kitti_translation_percent",
                          "kitti_rotation_deg_per_m",
                          "kitti_scaled",
                          "ape_rmse_m",
                          "ape_rmse_deg",
                          "rpe_rmse_m",
                          "rpe_rmse_deg",
                          "map_rmse_m",
                          "map_p95_m",
                          "nees_mean",
                          "real_time_factor",
                          "estimator_real_time_factor",
                          "seed",
                          "scenario",
                          "estimator",
                          "provenance"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  for (const char* sensor : {"imu", "camera", "lidar"}) {
    for (const char* key : {"produced", "used", "dropped"}) {
      EXPECT_TRUE(result.at("messages").at(sensor).contains(key)) << sensor << "." << key;
    }
  }
  for (const char* module : {"imu", "vision", "lidar"}) {
    for (const char* key : {"calls", "mean_ms", "p50_ms", "p95_ms", "max_ms", "degenerate_share", "nees_degenerate"}) {
      EXPECT_TRUE(result.at("modules").at(module).contains(key)) << module << "." << key;
    }
    EXPECT_EQ(result.at("modules").at(module).at("dof_histogram").size(), 7U);
  }
  for (const char* key : {"version", "git_commit", "seed", "scenario_digest", "machine", "threads", "estimator"}) {
    EXPECT_TRUE(result.at("provenance").contains(key)) << key;
  }
}

TEST(ResultJson, HasEveryKeyOfAnOrdinaryRun) {
  const auto result = result_of(testing::synthetic_record());
  expect_design_keys(result);
  EXPECT_EQ(result.at("status"), "ok");
  EXPECT_NEAR(result.at("progress_ratio").get<double>(), 0.97, 0.01);
  EXPECT_NEAR(result.at("map_rmse_m").get<double>(), 0.02, 1e-9);
  EXPECT_EQ(result.at("messages").at("camera").at("dropped").at("not finite"), 3);
  EXPECT_TRUE(result.at("modules").at("lidar").at("calls").is_number_integer());
}

TEST(ResultJson, HasEveryKeyOfARunThatEndedBeforeItBegan) {
  RunRecord record;
  record.fault = "out of memory";
  const auto result = result_of(record);
  expect_design_keys(result);
  EXPECT_EQ(result.at("status"), "error");
  EXPECT_EQ(result.at("fault"), "out of memory");
  EXPECT_TRUE(result.at("drift_percent").is_null());
}

TEST(ResultJson, HoldsNoNumberThatIsNotFinite) {
  RunRecord record = testing::synthetic_record();
  for (auto& stamped : record.estimate) stamped.pose.translation.x() = kNan;
  record.timing.push_back({0, Module::kLidar, kNan});
  const auto result = result_of(record);  // a NaN would be no JSON, and would not parse
  expect_design_keys(result);
  EXPECT_TRUE(result.at("drift_percent").is_null());
  EXPECT_EQ(result.at("status"), "lost");
}

TEST(ResultJson, SurvivesBytesThatAreNoText) {
  RunRecord record;
  record.fault = "bad \xff\xfe byte";
  EXPECT_NO_THROW(result_of(record));
}

TEST(DegeneracyCsv, HasTheColumnsThatReadersRelyOn) {
  ModuleHealth health;
  health.stamp_ns = 100'000'000;
  health.module = Module::kLidar;
  health.mode = ModuleMode::kPartial;
  health.eigenvalues << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  health.eigenvectors(2, 1) = 0.25;  // the third component of the second eigenvector
  health.well_conditioned = 5;
  std::istringstream csv(degeneracy_csv({health}));
  std::string header;
  std::string row;
  std::getline(csv, header);
  std::getline(csv, row);
  EXPECT_EQ(header.substr(0, 70), "stamp_ns,module,mode,lambda_1,lambda_2,lambda_3,lambda_4,lambda_5,lamb");
  EXPECT_NE(header.find("lambda_6,v_1_1,v_1_2,"), std::string::npos);
  EXPECT_TRUE(header.ends_with("v_6_5,v_6_6,well_conditioned"));
  EXPECT_EQ(row,
            "100000000,lidar,partial,1,2,3,4,5,6,1,0,0,0,0,0,0,1,0.25,0,0,0,0,0,1,0,0,0,0,0,0,1,0,0,0,0,0,0,1,0,"
            "0,0,0,0,0,1,5");
}

}  // namespace
}  // namespace plumbline
