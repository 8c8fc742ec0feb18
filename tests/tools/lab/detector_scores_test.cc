#include "tools/lab/detector_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "estimator/lidar/scan_matcher.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

/// A scan that every detector scores alike.
LabRow scan(double excess, double score, std::optional<double> angle_deg = std::nullopt) {
  LabRow row;
  row.worst_excess = excess;
  row.degenerate = excess > 1.0 ? 1 : 0;
  row.scores.assign(kDetectors.size(), score);
  row.angles_deg.assign(kDetectors.size(), angle_deg);
  return row;
}

constexpr double kWell = 0.1;
constexpr double kGrey = 1.2;
constexpr double kBad = 10.0;

TEST(DetectorScore, OfAPerfectDetectorIsOneWithItsThresholdInTheMiddleOfTheGap) {
  const DetectorScore score = score_detector(
      0, {{scan(kWell, 400.0), scan(kWell, 900.0), scan(kBad, 1.0, 2.0), scan(kBad, 4.0, 6.0), scan(kGrey, 1e9)}});
  EXPECT_EQ(score.degenerate, 2u);
  EXPECT_EQ(score.well, 2u);
  EXPECT_EQ(score.grey, 1u);
  EXPECT_DOUBLE_EQ(*score.area, 1.0);
  ASSERT_TRUE(score.choice);
  EXPECT_DOUBLE_EQ(score.choice->at.threshold, 40.0);  // sqrt(4 * 400)
  EXPECT_DOUBLE_EQ(score.choice->margin, 10.0);
  EXPECT_DOUBLE_EQ(score.choice->at.hits, 1.0);
  EXPECT_DOUBLE_EQ(score.choice->at.false_alarms, 0.0);
  EXPECT_DOUBLE_EQ(*score.angle_deg, 4.0);
}

TEST(DetectorScore, CountsTheShareOfPairsInTheRightOrder) {
  // Pairs (bad, well): (1,2) right, (1,3) right, (2.5,2) wrong, (2.5,3) right.
  const DetectorScore score =
      score_detector(0, {{scan(kBad, 1.0), scan(kWell, 2.0), scan(kBad, 2.5), scan(kWell, 3.0)}});
  EXPECT_DOUBLE_EQ(*score.area, 0.75);
  const DetectorScore tied = score_detector(0, {{scan(kBad, 1.0), scan(kWell, 1.0)}});
  EXPECT_DOUBLE_EQ(*tied.area, 0.5);
}

TEST(DetectorScore, TellsWhatTheThresholdInUseDoes) {
  const double in_use = ScanMatcherConfig{}.degeneracy_threshold;
  const std::vector<std::vector<LabRow>> runs{
      {scan(kBad, 0.1 * in_use), scan(kBad, 2.0 * in_use), scan(kWell, 0.5 * in_use), scan(kWell, 3.0 * in_use)}};
  const DetectorScore d = score_detector(0, runs);
  ASSERT_TRUE(d.in_use);
  EXPECT_DOUBLE_EQ(d.in_use->hits, 0.5);
  EXPECT_DOUBLE_EQ(d.in_use->false_alarms, 0.5);
  EXPECT_FALSE(score_detector(1, runs).in_use) << "the estimator goes by D alone";
}

TEST(DetectorScore, MeasuresHowLongAnOnsetGoesUnreported) {
  // Degeneracy begins at the third scan, and the score falls two scans later.
  const DetectorScore score =
      score_detector(0, {{scan(kWell, 100.0), scan(kWell, 100.0), scan(kBad, 100.0), scan(kBad, 100.0), scan(kBad, 1.0),
                          scan(kBad, 1.0), scan(kBad, 1.0)}});
  EXPECT_EQ(score.onsets, 1u);
  EXPECT_EQ(score.onsets_missed, 0u);
  EXPECT_DOUBLE_EQ(*score.latency_scans, 2.0);
}

TEST(DetectorScore, SaysNothingWithoutScansOfBothKinds) {
  const DetectorScore score = score_detector(0, {{scan(kWell, 1.0), scan(kWell, 2.0)}, {}});
  EXPECT_FALSE(score.area);
  EXPECT_FALSE(score.choice);
}

TEST(RegistrationEfficiency, IsTheRootMeanSquareOverTheBound) {
  LabRow one = scan(kWell, 1.0);
  one.error_over_selected = 1.0;
  one.error_over_all = 4.0;
  LabRow other = one;
  other.error_over_selected = 7.0;
  other.error_over_all = 28.0;
  const RegistrationEfficiency efficiency = registration_efficiency({{one, scan(kBad, 1.0)}, {other}});
  EXPECT_EQ(efficiency.scans, 2u);
  EXPECT_DOUBLE_EQ(*efficiency.over_selected, 2.0);
  EXPECT_DOUBLE_EQ(*efficiency.over_all, 4.0);
}

TEST(LabTable, IsReadBackAsWritten) {
  ScanTrial trial;
  trial.stamp_ns = 100'000'000;
  trial.label.excess << 3.0, 2.0, 0.5, 0.4, 0.3, 0.2;
  trial.detectors[1] = {12.5, std::numbers::pi / 90.0};
  trial.error_over_all = 2.5;
  const TemporaryDirectory directory;
  const auto path = directory.path() / "detectors.csv";
  std::ofstream(path) << lab_csv({trial, trial});
  const std::vector<LabRow> rows = read_lab_csv(path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[1].worst_excess, 3.0);
  EXPECT_EQ(rows[1].degenerate, 2);
  EXPECT_DOUBLE_EQ(rows[1].scores[1], 12.5);
  EXPECT_NEAR(*rows[1].angles_deg[1], 2.0, 1e-8);  // nine digits
  EXPECT_FALSE(rows[1].angles_deg[0]);
  EXPECT_FALSE(rows[1].error_over_selected);
  EXPECT_DOUBLE_EQ(*rows[1].error_over_all, 2.5);

  std::ofstream(path) << "stamp_ns,something else\n1,2\n";
  EXPECT_TRUE(read_lab_csv(path).empty());
  EXPECT_TRUE(read_lab_csv(directory.path() / "missing.csv").empty());
}

}  // namespace
}  // namespace plumbline
