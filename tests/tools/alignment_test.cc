#include "tools/evaluation/alignment.h"

#include <gtest/gtest.h>

#include "estimator/geometry/so3.h"
#include "tests/support/synthetic_record.h"

namespace plumbline {
namespace {

using testing::poses_at_200_hz;

const Pose kTilted{exp_so3({0.2, -0.1, 2.0}), {3.0, -4.0, 5.0}};

Pose rest_then_straight(double time_s) {
  return {Eigen::Quaterniond::Identity(), {1.5 * std::max(0.0, time_s - 2.0), 0.0, 0.0}};
}

Pose helix(double time_s) {
  return {exp_so3({0.0, 0.0, 0.5 * time_s}),
          {4.0 * std::cos(0.5 * time_s), 4.0 * std::sin(0.5 * time_s), 0.3 * time_s}};
}

/// What an estimator that is right but for its frame would have said.
StampedPoses seen_from(const Pose& truth_from_estimate, StampedPoses poses, double scale = 1.0) {
  for (auto& stamped : poses) {
    stamped.pose = truth_from_estimate.inverse() * stamped.pose;
    stamped.pose.translation /= scale;
  }
  return poses;
}

void expect_same(const Pose& found, const Pose& expected, double tolerance = 1e-9) {
  EXPECT_LT(expected.local(found).norm(), tolerance);
}

TEST(FirstSecondAlignment, IsExactForABodyAtRestInATiltedFrame) {
  const auto truth = poses_at_200_hz(10.0, rest_then_straight);
  expect_same(align_first_second(pair_poses(truth, seen_from(kTilted, truth))), kTilted);
}

TEST(FirstSecondAlignment, LooksAtTheFirstSecondOnly) {
  const auto truth = poses_at_200_hz(10.0, helix);
  auto estimate = seen_from(kTilted, truth);
  for (std::size_t i = 201; i < estimate.size(); ++i) estimate[i].pose = Pose{};
  expect_same(align_first_second(pair_poses(truth, estimate)), kTilted);
}

TEST(FirstSecondAlignment, AveragesAttitudesThatDiffer) {
  const auto truth = poses_at_200_hz(0.995, [](double) { return Pose{}; });
  auto estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].pose.rotation = exp_so3({0.0, 0.0, i % 2 == 0 ? 0.1 : -0.1});
  }
  expect_same(align_first_second(pair_poses(truth, estimate)), Pose{});
}

TEST(Alignment, RecoversTheFrameOfAnyPath) {
  for (const auto& path : {poses_at_200_hz(20.0, helix), poses_at_200_hz(20.0, rest_then_straight)}) {
    const auto pairs = pair_poses(path, seen_from(kTilted, path));
    for (const AlignmentKind kind : {AlignmentKind::kOrigin, AlignmentKind::kSe3, AlignmentKind::kSim3}) {
      const Alignment found = align(pairs, kind);
      expect_same(found.truth_from_estimate, kTilted, 1e-6);
      EXPECT_NEAR(found.scale, 1.0, 1e-9);
    }
  }
}

TEST(Alignment, YawTurnsAboutTheVerticalOnly) {
  const Pose turned{exp_so3({0.0, 0.0, 1.2}), {1.0, 2.0, 3.0}};
  const auto path = poses_at_200_hz(20.0, helix);
  expect_same(align(pair_poses(path, seen_from(turned, path)), AlignmentKind::kYaw).truth_from_estimate, turned);
  const Pose found = align(pair_poses(path, seen_from(kTilted, path)), AlignmentKind::kYaw).truth_from_estimate;
  EXPECT_NEAR(found.rotation.x(), 0.0, 1e-12);
  EXPECT_NEAR(found.rotation.y(), 0.0, 1e-12);
}

TEST(Alignment, Sim3FindsTheScale) {
  const auto path = poses_at_200_hz(20.0, helix);
  const Alignment found = align(pair_poses(path, seen_from(kTilted, path, 2.5)), AlignmentKind::kSim3);
  EXPECT_NEAR(found.scale, 2.5, 1e-6);
}

TEST(Pairing, InterpolatesTheDenserTrackAndSkipsItsGaps) {
  const auto truth = poses_at_200_hz(10.0, rest_then_straight);
  StampedPoses estimate;
  for (const std::int64_t stamp_ns : {2'502'500'000LL, 4'000'000'000LL, 10'008'000'000LL, 11'000'000'000LL}) {
    estimate.push_back({stamp_ns, Pose{}});
  }
  const auto pairs = pair_poses(truth, estimate);
  ASSERT_EQ(pairs.size(), 3U);  // the last lies a second past the truth's end, the third within 10 ms of it
  EXPECT_NEAR(pairs[0].truth.translation.x(), 1.5 * 0.5025, 1e-9);
  EXPECT_NEAR(pairs[2].truth.translation.x(), 12.0, 1e-9);
}

TEST(Pairing, HoldsAnEstimateThatStopsEarly) {
  const auto truth = poses_at_200_hz(10.0, rest_then_straight);
  const StampedPoses estimate(truth.begin(), truth.begin() + 1001);
  const auto pairs = pair_poses_to_end(truth, estimate);
  ASSERT_EQ(pairs.size(), truth.size());
  EXPECT_NEAR(pairs.back().estimate.translation.x(), 4.5, 1e-9);
}

}  // namespace
}  // namespace plumbline
