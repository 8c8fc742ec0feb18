#include <gtest/gtest.h>

#include <numbers>

#include "estimator/geometry/so3.h"
#include "sim/random_stream.h"
#include "tests/support/synthetic_record.h"
#include "tools/evaluation/consistency.h"
#include "tools/evaluation/figures.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

using testing::poses_at_200_hz;

constexpr double kSpeed = 2.0;

double travelled(double time_s) { return kSpeed * std::max(0.0, time_s - 2.0); }

/// Rests for 2 s, then goes straight on.
Pose straight(double time_s) { return {Eigen::Quaterniond::Identity(), {travelled(time_s), 0.0, 0.0}}; }

Pose scaled(double time_s, double factor) {
  return {Eigen::Quaterniond::Identity(), {factor * travelled(time_s), 0.0, 0.0}};
}

TEST(Progress, IsTheEstimatesScale) {
  const auto truth = poses_at_200_hz(30.0, straight);
  for (const double factor : {0.0, 0.5, 0.98, 1.3}) {
    const auto figures = trajectory_figures(truth, poses_at_200_hz(30.0, [&](double t) { return scaled(t, factor); }));
    EXPECT_NEAR(figures.progress.whole.value(), factor, 1e-9);
    EXPECT_NEAR(figures.progress.worst_5s.value(), factor, 1e-9);
    EXPECT_NEAR(figures.drift_percent.value(), 100.0 * std::abs(1.0 - factor), 1e-9);
  }
}

TEST(Progress, WorstWindowShowsAFreezeThatTheWholeHides) {
  const auto truth = poses_at_200_hz(42.0, straight);
  const auto figures = trajectory_figures(truth, poses_at_200_hz(42.0, [](double time_s) {
                                            const double frozen = std::clamp(
                                                time_s - 20.0, 0.0, 6.0);  // for 6 s, then a jump that makes up for it
                                            return scaled(time_s < 26.0 ? time_s - frozen : time_s, 1.0);
                                          }));
  EXPECT_NEAR(figures.progress.whole.value(), 1.0, 1e-9);
  EXPECT_LT(std::min(figures.progress.worst_5s.value(), 2.0 - figures.progress.worst_5s.value()), 1e-9);
}

TEST(Progress, IsNullForATruthAtRest) {
  const auto rest = poses_at_200_hz(10.0, [](double) { return Pose{}; });
  const auto figures = trajectory_figures(rest, rest);
  EXPECT_FALSE(figures.progress.whole);
  EXPECT_FALSE(figures.progress.worst_5s);
  EXPECT_FALSE(figures.drift_percent);
  EXPECT_FALSE(figures.kitti.translation_percent);
  EXPECT_NEAR(figures.ape.value().translation_m, 0.0, 1e-12);
}

TEST(RelativeError, BySecondShowsWhenItArose) {
  const auto truth = poses_at_200_hz(8.0, straight);
  // Walks at 1.1 times the pace through the second from 5 s on.
  const auto figures = trajectory_figures(truth, poses_at_200_hz(8.0, [](double time_s) {
                                            Pose pose = straight(time_s);
                                            pose.translation.x() += 0.2 * std::clamp(time_s - 5.0, 0.0, 1.0);
                                            return pose;
                                          }));
  std::vector<double> seconds;
  for (const RootMeanSquare& second : figures.rpe_by_second) seconds.push_back(second.translation_m);
  ASSERT_EQ(seconds.size(), 8U);  // the last holds the one motion that begins at 7 s
  EXPECT_NEAR(seconds[3], 0.0, 1e-9);
  // Motions that begin between 4 s and 5 s take in a share of it that grows linearly to all, those after it the rest.
  EXPECT_NEAR(seconds[4], 0.2 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(seconds[5], 0.2 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(seconds[6], 0.0, 1e-9);
  double squares = 0.0;
  for (const double second : seconds) squares += second * second / 7.0;
  EXPECT_NEAR(std::sqrt(squares), figures.rpe.value().translation_m, 1e-3);
}

TEST(Drift, IsTheErrorAtTheTruthsEndOverTheDistance) {
  const auto truth = poses_at_200_hz(27.0, straight);  // 50 m
  const auto estimate = poses_at_200_hz(27.0, [](double time_s) {
    return Pose{Eigen::Quaterniond::Identity(), {travelled(time_s), 0.01 * travelled(time_s), 0.0}};
  });
  const auto figures = trajectory_figures(truth, estimate);
  EXPECT_NEAR(figures.distance_m, 50.0, 1e-9);
  EXPECT_NEAR(figures.duration_s, 27.0, 1e-12);
  EXPECT_NEAR(figures.final_error_m.value(), 0.5, 1e-9);
  EXPECT_NEAR(figures.drift_percent.value(), 1.0, 1e-9);
}

TEST(Drift, HoldsAnEstimateThatStopsEarly) {
  const auto truth = poses_at_200_hz(12.0, straight);                                     // 20 m
  const auto figures = trajectory_figures(truth, {truth.begin(), truth.begin() + 1401});  // 10 m
  EXPECT_NEAR(figures.drift_percent.value(), 50.0, 1e-9);
  EXPECT_NEAR(figures.progress.whole.value(), 0.5, 1e-9);
}

TEST(Kitti, IsTheShareOfEverySegmentAndScalesWithAShortPath) {
  const auto truth = poses_at_200_hz(27.0, straight);
  const auto estimate = poses_at_200_hz(27.0, [](double t) { return scaled(t, 0.97); });
  const auto figures = trajectory_figures(truth, estimate);
  EXPECT_TRUE(figures.kitti.scaled);
  // Segments end at the first pose past their length, one step of 1 cm at most.
  EXPECT_NEAR(figures.kitti.translation_percent.value(), 3.0, 0.02);
  EXPECT_NEAR(figures.kitti.rotation_deg_per_m.value(), 0.0, 1e-9);
}

TEST(Kitti, UsesTheBenchmarksLengthsOnALongPath) {
  const auto fast = [](double time_s, double yaw_per_m) {
    return Pose{exp_so3({0.0, 0.0, yaw_per_m * 20.0 * time_s}), {20.0 * time_s, 0.0, 0.0}};
  };
  const auto truth = poses_at_200_hz(45.0, [&](double t) { return fast(t, 0.0); });  // 900 m
  const double deg_per_m = 0.001;
  const auto estimate = poses_at_200_hz(45.0, [&](double t) { return fast(t, deg_per_m * std::numbers::pi / 180.0); });
  const auto figures = trajectory_figures(truth, estimate);
  EXPECT_FALSE(figures.kitti.scaled);
  EXPECT_NEAR(figures.kitti.rotation_deg_per_m.value(), deg_per_m, 1e-5);
}

TEST(AbsoluteError, SettlesTheRollAboutAStraightPath) {
  const auto truth = poses_at_200_hz(27.0, straight);
  auto estimate = truth;
  const Pose frame{exp_so3({1.0, 0.4, -2.0}), {3.0, 2.0, 1.0}};
  for (auto& stamped : estimate) stamped.pose = frame * stamped.pose;
  const auto figures = trajectory_figures(truth, estimate);
  EXPECT_NEAR(figures.ape.value().translation_m, 0.0, 1e-6);
  EXPECT_NEAR(figures.ape.value().rotation_deg, 0.0, 1e-5);
}

TEST(RelativeError, IsTheErrorGainedPerSecond) {
  const auto truth = poses_at_200_hz(20.0, [](double t) { return Pose{Eigen::Quaterniond::Identity(), {t, 0, 0}}; });
  const auto estimate = poses_at_200_hz(20.0, [](double t) {
    return Pose{Eigen::Quaterniond::Identity(), {1.02 * t, 0, 0}};
  });
  EXPECT_NEAR(trajectory_figures(truth, estimate).rpe.value().translation_m, 0.02, 1e-9);
  EXPECT_NEAR(trajectory_figures(truth, estimate).rpe.value().rotation_deg, 0.0, 1e-9);
}

TEST(Lost, WhenTheErrorOutgrowsTheDistanceToTheEnd) {
  const auto truth = poses_at_200_hz(52.0, straight);  // 100 m
  const auto lagging = [&](double factor) {
    return trajectory_figures(truth, poses_at_200_hz(52.0, [=](double t) { return scaled(t, factor); })).lost_since_s;
  };
  EXPECT_FALSE(lagging(0.90));                     // the error is 10 % of the distance, never 1 m more
  EXPECT_NEAR(lagging(0.80).value(), 7.0, 0.011);  // 20 % exceeds 1 m + 10 % from 10 m on, at 7 s
}

TEST(Lost, NotWhenTheEstimateComesBack) {
  const auto truth = poses_at_200_hz(52.0, straight);
  const auto estimate = poses_at_200_hz(52.0, [](double t) { return scaled(t, t > 20.0 && t < 30.0 ? 0.5 : 1.0); });
  EXPECT_FALSE(trajectory_figures(truth, estimate).lost_since_s);
}

TEST(MapError, IsMeasuredInDriftsAlignment) {
  const Pose truth_from_estimate{Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}};
  std::vector<MapPoint> map;
  for (int i = 0; i < 50'000; ++i) map.push_back({{0.001F * static_cast<float>(i), 0.0F, -1.9F}, 0.0F});
  std::size_t asked = 0;
  const MapError error = map_error(map, truth_from_estimate, [&](const Eigen::Vector3d& point) {
    ++asked;
    return std::abs(point.z());  // the true surface is the floor
  });
  EXPECT_LE(asked, 20'000U);
  EXPECT_NEAR(error.rmse_m.value(), 0.1, 1e-6);
  EXPECT_NEAR(error.p95_m.value(), 0.1, 1e-6);
  EXPECT_FALSE(map_error({}, {}, [](const Eigen::Vector3d&) { return 0.0; }).rmse_m);
}

struct NoisyWalk {
  std::vector<Odometry> odometry;
  StampedPoses truth;
};

/// A thousand seconds of outputs that claim an error of 1e-3 each and have one of `sigmas`.
NoisyWalk noisy_walk(const Vector6d& sigmas, const Eigen::Vector3d& turn) {
  RandomStream noise(3, "nees");
  const double claimed = 1e-3;
  NoisyWalk walk;
  Pose true_pose;
  Pose estimated_pose;
  for (std::int64_t i = 0; i <= 200'000; ++i) {
    if (i > 0) {
      const Pose motion{exp_so3(turn), {0.01, 0.0, 0.001}};
      Vector6d error;
      for (int k = 0; k < 6; ++k) error[k] = sigmas[k] * noise.gaussian();
      true_pose = true_pose * motion;
      estimated_pose = estimated_pose * motion.retract(error);
    }
    walk.truth.push_back({i * 5'000'000, true_pose});
    Odometry output;
    output.stamp_ns = i * 5'000'000;
    output.world_from_body = estimated_pose;
    output.increment_covariance = claimed * claimed * Matrix6d::Identity();
    walk.odometry.push_back(output);
  }
  return walk;
}

TEST(Nees, IsOneForErrorsAsLargeAsClaimed) {
  const NoisyWalk walk = noisy_walk(1e-3 * Vector6d::Ones(), {0.001, 0.002, 0.01});
  // 1000 increments of 6 degrees of freedom: standard deviation sqrt(2 / 6000) = 0.018.
  EXPECT_NEAR(nees_mean(increment_errors(walk.odometry, walk.truth)).value(), 1.0, 0.08);
}

TEST(Nees, AlongDegenerateDirectionsSeesNothingOfTheOthers) {
  Vector6d sigmas = 1e-3 * Vector6d::Ones();
  sigmas[3] = 2e-3;
  const NoisyWalk walk = noisy_walk(sigmas, Eigen::Vector3d::Zero());
  std::vector<ModuleHealth> health;
  for (std::int64_t second = 1; second <= 1000; ++second) {
    ModuleHealth report;
    report.stamp_ns = second * 1'000'000'000 - 100'000'000;
    report.module = Module::kLidar;
    report.well_conditioned = second % 2 == 0 ? 5 : 6;
    report.eigenvectors.col(0).swap(report.eigenvectors.col(3));  // the weakest: along x
    health.push_back(report);
    report.module = Module::kVision;
    report.well_conditioned = 3;
    health.push_back(report);
  }
  const std::vector<IncrementError> increments = increment_errors(walk.odometry, walk.truth);
  // Twice the error claimed; 500 increments of one direction: standard deviation 4 sqrt(2 / 500) = 0.25.
  EXPECT_NEAR(nees_degenerate(increments, health, Module::kLidar).value(), 4.0, 1.0);
  EXPECT_FALSE(nees_degenerate(increments, health, Module::kImu));
  // A report of long ago says nothing of now.
  health.resize(2);
  EXPECT_FALSE(nees_degenerate(increments, health, Module::kLidar));
}

TEST(Nees, IsNullWithoutCovariances) {
  std::vector<Odometry> odometry(500);
  StampedPoses truth;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    odometry[i].stamp_ns = static_cast<std::int64_t>(i) * 5'000'000;
    truth.push_back({odometry[i].stamp_ns, Pose{}});
  }
  EXPECT_FALSE(nees_mean(increment_errors(odometry, truth)));
  EXPECT_FALSE(nees_mean(increment_errors({}, {})));
}

TEST(ModuleFigures, CountsCallsAndDirections) {
  RunRecord record;
  for (const double ms : {1.0, 2.0, 3.0, 10.0}) record.timing.push_back({0, Module::kLidar, 1e-3 * ms});
  for (const int directions : {6, 6, 5, 0}) {
    ModuleHealth health;
    health.module = Module::kLidar;
    health.well_conditioned = directions;
    record.health.push_back(health);
  }
  const ModuleFigures lidar = module_figures(record, Module::kLidar);
  EXPECT_EQ(lidar.calls, 4);
  EXPECT_NEAR(lidar.mean_ms.value(), 4.0, 1e-9);
  EXPECT_NEAR(lidar.p50_ms.value(), 2.5, 1e-9);
  EXPECT_NEAR(lidar.max_ms.value(), 10.0, 1e-9);
  EXPECT_NEAR(lidar.degenerate_share.value(), 0.5, 1e-12);
  EXPECT_EQ(lidar.dof_histogram, (std::array<std::int64_t, 7>{1, 0, 0, 0, 0, 1, 2}));
  EXPECT_FALSE(module_figures(record, Module::kVision).degenerate_share);
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  EXPECT_NEAR(quantile({3.0, 1.0, 2.0}, 0.5).value(), 2.0, 1e-12);
  EXPECT_NEAR(quantile({4.0, 1.0, 2.0, 3.0}, 0.95).value(), 3.85, 1e-12);
  EXPECT_FALSE(quantile({}, 0.5));
}

}  // namespace
}  // namespace plumbline
