#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/localize.h"
#include "tests/estimator/localization_world.h"

namespace plumbline {
namespace {

using testing::LocalizedRun;
using testing::Motion;
using testing::stroll;

/// 3 cm and 0.06 degrees a second: 3 % of the way, thirty times what the odometry does on a good day.
Pose drifting(double t) { return {rotation_from_rpy({0.0, 0.0, 0.001 * t}), {0.02 * t, -0.02 * t, 0.005 * t}}; }
Pose no_drift(double) { return {}; }

std::vector<double> errors_after(const LocalizedRun& run, double from_s, const Motion& truth = stroll) {
  std::vector<double> errors;
  for (const Odometry& output : run.outputs) {
    if (output.stamp_ns >= static_cast<std::int64_t>(1e9 * from_s)) {
      errors.push_back(testing::position_error(output, truth));
    }
  }
  return errors;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::vector<MapAgreement> agreements(const LocalizedRun& run) {
  std::vector<MapAgreement> list;
  for (const MapMatch& match : run.matches) list.push_back(match.agreement);
  return list;
}

/// The steps of the output that are not odometry's, both seen from the body.
double largest_step_beside_odometry(const LocalizedRun& run, const Motion& motion, const Motion& drift) {
  double largest = 0.0;
  for (std::size_t i = 1; i < run.outputs.size(); ++i) {
    const double before = 1e-9 * static_cast<double>(run.outputs[i - 1].stamp_ns);
    const double now = 1e-9 * static_cast<double>(run.outputs[i].stamp_ns);
    const Pose odometry = (drift(before) * motion(before)).inverse() * drift(now) * motion(now);
    const Pose output = run.outputs[i - 1].world_from_body.inverse() * run.outputs[i].world_from_body;
    largest = std::max(largest, (odometry.translation - output.translation).norm());
  }
  return largest;
}

class LocalizationInAHall : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    hall_ = new testing::BoxWorld(testing::pillared_hall(40.0));
    map_ = new PriorMap(testing::mapped_along_x(*hall_, 20.0));
  }
  static void TearDownTestSuite() {
    delete hall_;
    delete map_;
  }
  static testing::BoxWorld* hall_;
  static PriorMap* map_;
};
testing::BoxWorld* LocalizationInAHall::hall_ = nullptr;
PriorMap* LocalizationInAHall::map_ = nullptr;

// Odometry drifts by 2.9 cm a second. A correction is measured at the end of two seconds' scans and spent over one
// more, so that the output trails by at most three seconds' drift, 9 cm, and by half of that in the mean.
TEST_F(LocalizationInAHall, OdometrysDriftStaysOut) {
  const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, drifting, 16.0);
  ASSERT_TRUE(run.outputs.back().localized);
  const std::vector<double> errors = errors_after(run, 6.0);
  EXPECT_LT(median(errors), 0.06);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.10);
  const Pose raw = drifting(16.0) * stroll(16.0);
  EXPECT_GT((raw.translation - stroll(16.0).translation).norm(), 0.3);
}

TEST_F(LocalizationInAHall, ConvergesInTwoOrThreeIterations) {
  const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, drifting, 12.0);
  ASSERT_GE(run.matches.size(), 5u);
  for (std::size_t i = 2; i < run.matches.size(); ++i) EXPECT_LE(run.matches[i].iterations, 3);
}

// The largest corrections, 6 cm of two seconds' drift, take a second; at most half as fast again by the easing.
TEST_F(LocalizationInAHall, TheOutputNeverJumps) {
  const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, drifting, 12.0);
  EXPECT_LT(largest_step_beside_odometry(run, stroll, drifting), 1.5 * 0.12 * 0.005);
}

TEST_F(LocalizationInAHall, TwoMatchesHaveToAgreeBeforeTheFirstIsBelieved) {
  const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, no_drift, 4.5);
  EXPECT_THAT(agreements(run), ::testing::ElementsAre(MapAgreement::kUnconfirmed, MapAgreement::kAgrees));
}

TEST_F(LocalizationInAHall, AStartHalfAMetreOffIsFound) {
  LocalizationConfig config;
  config.map_from_start = {rotation_from_rpy({0.0, 0.0, 0.05}), {0.4, -0.3, 0.0}};
  const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, no_drift, 8.0, config);
  ASSERT_TRUE(run.outputs.back().localized);
  // The map's own points err by a centimetre or two.
  EXPECT_LT(testing::position_error(run.outputs.back(), stroll), 0.04);
}

// The hall's floor, ceiling and walls fit anywhere along it; its pillars do not.
TEST_F(LocalizationInAHall, AWrongStartIsReportedAndOdometryGoesOn) {
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(3.0, 0.0, 0.0), Eigen::Vector3d(7.0, 2.5, 0.0)}) {
    LocalizationConfig config;
    config.map_from_start.translation = off;
    const LocalizedRun run = testing::run_localized(*hall_, *map_, stroll, no_drift, 8.0, config);
    for (const Odometry& output : run.outputs) {
      const double t = 1e-9 * static_cast<double>(output.stamp_ns);
      ASSERT_FALSE(output.localized);
      ASSERT_LT((config.map_from_start * stroll(t)).local(output.world_from_body).norm(), 1e-9);
    }
    EXPECT_THAT(agreements(run), ::testing::Each(MapAgreement::kDisagrees));
  }
}

TEST_F(LocalizationInAHall, AnotherPlacesMapIsReported) {
  const PriorMap elsewhere = testing::mapped_along_x(testing::furnished_room(), 3.0);
  const LocalizedRun run = testing::run_localized(*hall_, elsewhere, stroll, no_drift, 10.0);
  for (const Odometry& output : run.outputs) ASSERT_FALSE(output.localized);
}

// The map ends where the lidar's view from its last scan does: the hall is walled off 5 m on in what was mapped.
TEST_F(LocalizationInAHall, HavingLeftTheMapTheLastCorrectionIsHeld) {
  PriorMap part = *map_;
  const auto beyond = [](const FeaturePoint& f) { return f.position.x() > 8.0F; };
  std::erase_if(part.surfaces.planes, beyond);
  std::erase_if(part.surfaces.edges, beyond);
  const Motion fast = [](double t) { return stroll(2.0 * t); };
  const LocalizedRun run = testing::run_localized(*hall_, part, fast, no_drift, 16.0);
  EXPECT_TRUE(std::any_of(run.outputs.begin(), run.outputs.end(), [](const Odometry& o) { return o.localized; }));
  EXPECT_FALSE(run.outputs.back().localized);
  EXPECT_EQ(run.matches.back().agreement, MapAgreement::kOffMap);
  // Odometry is perfect here, so what is held must be nearly nothing.
  EXPECT_LT(testing::position_error(run.outputs.back(), fast), 0.3);
}

TEST_F(LocalizationInAHall, AMapWithoutNormalsServes) {
  const PriorMap bare = testing::mapped_along_x(*hall_, 20.0, /*with_normals=*/false);
  const LocalizedRun run = testing::run_localized(*hall_, bare, stroll, drifting, 12.0);
  ASSERT_TRUE(run.outputs.back().localized);
  EXPECT_LT(median(errors_after(run, 6.0)), 0.07);
}

TEST_F(LocalizationInAHall, IsDeterministic) {
  const auto end = [&] {
    return testing::run_localized(*hall_, *map_, stroll, drifting, 6.0).outputs.back().world_from_body.translation;
  };
  EXPECT_EQ(end(), end());
}

TEST_F(LocalizationInAHall, ARobotsOwnCodeHasItInOneCall) {
  std::vector<MapPoint> points = map_->thinned;
  const auto make = [&] {
    return make_localized_estimator(std::make_unique<testing::DriftingOdometry>(stroll, no_drift),
                                    testing::lidar_calibration(), points, Pose{});
  };
  EXPECT_NE(make(), nullptr);
  points.clear();
  EXPECT_THROW(make(), std::invalid_argument);
}

// Along a smooth tunnel no match can tell: there odometry's drift stays, and across it is taken out.
TEST(Localization, AlongATunnelOdometryIsLeftAlone) {
  const testing::BoxWorld tunnel = testing::smooth_tunnel();
  const PriorMap map = testing::mapped_along_x(tunnel, 14.0);
  const Motion straight = [](double t) { return Pose{Eigen::Quaterniond::Identity(), {t, 0.0, 0.0}}; };
  const Motion drift = [](double t) { return Pose{Eigen::Quaterniond::Identity(), {0.02 * t, 0.02 * t, 0.0}}; };
  const LocalizedRun run = testing::run_localized(tunnel, map, straight, drift, 12.0);
  const Eigen::Vector3d off = run.outputs.back().world_from_body.translation - straight(12.0).translation;
  EXPECT_NEAR(off.x(), 0.24, 0.03);
  EXPECT_LT(std::abs(off.y()), 0.08);
  ASSERT_FALSE(run.health.empty());
  EXPECT_EQ(run.health.back().well_conditioned, 5);
  EXPECT_EQ(run.health.back().module, Module::kLocalization);
}

// Thesis, Fig. 8.5: at 0.5 Hz the particle filter errs five times as much. Odometry is exact here, as good as the
// thesis's, so that what errs is the localization.
TEST_F(LocalizationInAHall, AParticleFilterErrsThreeTimesAsMuch) {
  LocalizationConfig particles;
  particles.method = LocalizationMethod::kParticleFilter;
  const LocalizedRun ours = testing::run_localized(*hall_, *map_, stroll, no_drift, 18.0);
  const LocalizedRun theirs = testing::run_localized(*hall_, *map_, stroll, no_drift, 18.0, particles);
  const double our_error = median(errors_after(ours, 6.0));
  const double their_error = median(errors_after(theirs, 6.0));
  RecordProperty("matcher_mm", std::to_string(1e3 * our_error));
  RecordProperty("particle_filter_mm", std::to_string(1e3 * their_error));
  EXPECT_LE(our_error, their_error / 3.0);
}

}  // namespace
}  // namespace plumbline
