#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/program_fixture.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

/// The program on eight metres of a garage, with hardly any images: localization is the lidar's.
class MapProgram : public ProgramFixture {
 protected:
  MapProgram() {
    directory_.write("walk.yaml",
                     "world: {scene: garage, seed: 3}\n"
                     "motion: {rest_s: 1, smoothing_s: 0.5, waypoints: [[6, 4.75, 1.5], [14, 4.75, 1.5]]}\n"
                     "rig: {camera: {rate_hz: 5, width: 160, height: 120}}\n"
                     "estimator: {name: imu_lidar}\n");
  }
  nlohmann::json result(const std::string& run) const { return nlohmann::json::parse(content(run + "/result.json")); }
  bool exists(const std::string& name) const { return std::filesystem::exists(directory_.path() / name); }
};

TEST_F(MapProgram, ARunIsLocalizedOnTheMapOfAnother) {
  ASSERT_EQ(call("run walk.yaml --seed 1 --out first"), 0) << content("said.txt");
  EXPECT_FALSE(result("first").contains("localization"));
  ASSERT_EQ(call("run walk.yaml --seed 2 --map first/map.ply --out second"), 0) << content("said.txt");
  EXPECT_THAT(content("said.txt"), HasSubstr("localized   at the end"));
  const nlohmann::json localization = result("second").at("localization");
  EXPECT_EQ(localization.at("map"), "first/map.ply");
  EXPECT_EQ(localization.at("localized_at_end"), true);
  EXPECT_GE(localization.at("outcomes").at("agrees"), 1);
  // Both runs err by a centimetre or two over so short a way.
  EXPECT_LT(localization.at("error_median_m"), 0.05);
  EXPECT_THAT(content("second/localization.csv"), HasSubstr(",agrees,"));
  EXPECT_THAT(content("second/report.html"), HasSubstr("Localization"));
  EXPECT_THAT(content("second/degeneracy.csv"), HasSubstr(",localization,"));

  // The same map again, from its own recording; and both maps make one.
  ASSERT_EQ(call("merge-maps first/map.ply second/map.ply --out both.ply"), 0) << content("said.txt");
  EXPECT_TRUE(exists("both.ply"));
  EXPECT_TRUE(exists("both.png"));
  ASSERT_EQ(call("run walk.yaml --seed 2 --map both.ply --out third"), 0) << content("said.txt");
  EXPECT_EQ(result("third").at("localization").at("localized_at_end"), true);

  // Ten metres and a quarter turn off nothing fits.
  EXPECT_EQ(call("merge-maps first/map.ply second/map.ply --b-start 10 6 0 90 --out wrong.ply"), 1);
  EXPECT_THAT(content("said.txt"), HasSubstr("second/map.ply on first/map.ply: "));
  EXPECT_FALSE(exists("wrong.ply"));
  EXPECT_FALSE(exists("wrong.png"));
}

/// Elsewhere on the survey's way and facing the other way, from a start that the run is told.
TEST_F(MapProgram, ARunIsLocalizedOnTheMapOfItsSurvey) {
  directory_.write("localized.yaml",
                   "base: walk.yaml\n"
                   "motion: {rest_s: 1, smoothing_s: 0.5, waypoints: [[12, 4.75, 1.5], [7, 4.75, 1.5]]}\n"
                   "localization: {survey: walk.yaml}\n");
  ASSERT_EQ(call("run localized.yaml --seed 2 --out localized"), 0) << content("said.txt");
  const nlohmann::json localization = result("localized").at("localization");
  EXPECT_THAT(std::string(localization.at("map")), HasSubstr("walk.yaml"));
  EXPECT_EQ(localization.at("localized_at_end"), true);
  // Both err by a centimetre or two over so short a way.
  EXPECT_LT(localization.at("error_median_m"), 0.05);

  directory_.write("again.yaml", "base: walk.yaml\nlocalization: {survey: localized.yaml}\n");
  EXPECT_EQ(call("run again.yaml --out again"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("a survey is neither localized nor flown in closed loop"));
  directory_.write("none.yaml", "base: walk.yaml\nlocalization: {survey: nowhere.yaml}\n");
  EXPECT_EQ(call("run none.yaml --out none"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("localization.survey"));
}

TEST_F(MapProgram, AMapThatCannotBeUsedIsBadInput) {
  directory_.write("empty.ply",
                   "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
                   "z\nend_header\n");
  EXPECT_EQ(call("run walk.yaml --map empty.ply --out out"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("empty.ply: it has no points"));
  EXPECT_FALSE(exists("out"));
  directory_.write("far.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 1\nDATA ascii\n3000 2000 1\n");
  EXPECT_EQ(call("run walk.yaml --map far.pcd --out out"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("m from the start"));
  EXPECT_EQ(call("run walk.yaml --map no.ply --out out"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("no.ply: cannot be read"));
}

}  // namespace
}  // namespace plumbline
