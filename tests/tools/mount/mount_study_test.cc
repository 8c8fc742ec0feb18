#include "tools/mount/mount_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

class MountStudyFile : public ::testing::Test {
 protected:
  MountStudyFile() { directory_.write("walk.yaml", "motion: {waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]}\n"); }

  MountStudy read(const std::string& text) const {
    return read_mount_study(directory_.write("study.yaml", "scenarios: [walk.yaml]\n" + text));
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryDirectory directory_;
};

TEST_F(MountStudyFile, IsReadWithEverythingThatMayStandInIt) {
  const MountStudy study = read(R"(
vehicle: car
mount:
  rig.pitch_deg: {range: [0, 90], step: 45}
  rig.lidar.z_m: [0.1, 0.3]
seeds: 3
estimators: [vloam, imu_lidar]
limits: {own_body_share: 0.2, overlap: 0.4, time_s: 100}
weigh: {drift: 2, worst_direction: 0, coverage: 1, degenerate_time: 0}
trial: {mountings: 4, choose: spread}
surfaces: [asphalt]
)");
  EXPECT_EQ(study.name, "study");
  ASSERT_EQ(study.scenarios.size(), 1u);
  ASSERT_EQ(study.runs.axes.size(), 2u);
  EXPECT_EQ(study.runs.axes[1].values.size(), 3u);
  EXPECT_EQ(study.runs.fixed, std::vector<std::string>{"motion.vehicle=car"});
  EXPECT_EQ(study.runs.seeds.size(), 3u);
  EXPECT_EQ(study.judged, "vloam");
  EXPECT_DOUBLE_EQ(study.limits.own_body_share, 0.2);
  EXPECT_DOUBLE_EQ(study.runs.limits.time_s, 100.0);
  EXPECT_DOUBLE_EQ(study.weights.drift, 2.0);
  EXPECT_TRUE(study.trial.spread);
}

TEST_F(MountStudyFile, NamesWhatItCannotUse) {
  EXPECT_THAT(refusal("mount: {rig.pich_deg: [0, 45]}"), HasSubstr("rig.pitch_deg"));
  EXPECT_THAT(refusal("mount: {rig.pitch_deg: [0, steep]}"), HasSubstr("numbers"));
  EXPECT_THAT(refusal("seeds: 2"), HasSubstr("mount"));
  EXPECT_THAT(refusal("mount: {rig.pitch_deg: [0]}\nweigh: {drift: 0, worst_direction: 0, coverage: 0, "
                      "degenerate_time: 0}"),
              HasSubstr("above 0"));
  EXPECT_THAT(refusal("mount: {rig.pitch_deg: [0]}\ntrial: {choose: luckiest}"), HasSubstr("luckiest"));
  EXPECT_THAT(refusal("mount: {rig.pitch_deg: [0]}\nlimits: {overlap: 2}"), HasSubstr("study.yaml:3"));
}

TEST_F(MountStudyFile, AsksForScenariosThatExist) {
  const auto path = directory_.write("other.yaml", "scenarios: [missing.yaml]\nmount: {rig.pitch_deg: [0]}\n");
  EXPECT_THROW(read_mount_study(path), InputError);
}

}  // namespace
}  // namespace plumbline
