#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include "estimator/estimator.h"
#include "estimator/geometry/so3.h"
#include "estimator/lidar/steady_motion.h"
#include "estimator/lidar/sweep_assembler.h"
#include "tests/support/box_world.h"

namespace plumbline {
namespace {

using testing::Motion;

constexpr std::int64_t kClock_ns = 10'000'000;

Calibration calibration_of(int rings, double sweep_rate_hz) {
  Calibration calibration;
  calibration.has_camera = false;
  calibration.imu_rate_hz = 100.0;
  calibration.lidar_rings = rings;
  calibration.lidar_rate_hz = sweep_rate_hz;
  return calibration;
}

/// An estimator without an IMU, its clock, and what it put out.
class LoamRun {
 public:
  explicit LoamRun(const Calibration& calibration, EstimatorConfig config = {}, const std::string& name = "loam") {
    config.imu_enabled = false;
    estimator_ = make_estimator(name, calibration, config);
  }

  void add(const LidarScan& scan) {
    wait_until(scan.end_ns);
    estimator_->add(scan);
  }
  void wait_until(std::int64_t stamp_ns) {
    for (; clock_ns_ < stamp_ns; clock_ns_ += kClock_ns) estimator_->add(ImuSample{clock_ns_ + kClock_ns, {}, {}});
    for (const Odometry& o : estimator_->take()) {
      poses_[o.stamp_ns] = o.world_from_body;
      newest_ = o;
    }
  }
  /// Sweeps of the turned scanner, and the output after them.
  void follow(const testing::BoxWorld& world, const Motion& motion, std::int64_t sweeps, std::uint64_t seed) {
    RandomStream noise(seed, "lidar");
    for (std::int64_t sweep = 0; sweep < sweeps; ++sweep) {
      for (const LidarScan& part : testing::turned_scanner_sweep(world, motion, sweep, 0.01, noise)) add(part);
    }
    wait_until(sweeps * 1'000'000'000 + kClock_ns);
  }
  const Pose& at(std::int64_t stamp_ns) const { return poses_.at(stamp_ns); }
  const Odometry& newest() const { return newest_; }
  const Estimator& estimator() const { return *estimator_; }

  /// Of the motion between two stamps, [rotation; translation].
  Vector6d error(const Motion& truth, std::int64_t from_ns, std::int64_t to_ns) const {
    const Pose moved = truth(1e-9 * static_cast<double>(from_ns)).inverse() * truth(1e-9 * static_cast<double>(to_ns));
    return moved.local(at(from_ns).inverse() * at(to_ns));
  }

 private:
  std::unique_ptr<Estimator> estimator_;
  std::int64_t clock_ns_ = 0;
  std::map<std::int64_t, Pose> poses_;
  Odometry newest_;
};

Motion turning_walk(double speed_mps, double rate) {
  return [=](double t) {
    return Pose{exp_so3({0.0, 0.0, rate * t}), {speed_mps * t - 2.0, 0.3 * std::sin(0.4 * t), 0.2}};
  };
}

TEST(Loam, FollowsATurnedScannerWithoutAnImu) {
  const testing::BoxWorld room = testing::furnished_room();
  const Motion motion = turning_walk(0.4, 0.1);
  LoamRun run(calibration_of(40, 1.0));
  run.follow(room, motion, 6, 1);
  // Two metres and half a radian of motion, in motion from the first sample on, measured to 1 cm a return.
  const Vector6d error = run.error(motion, 2'100'000'000, 6'010'000'000);
  EXPECT_LT(error.tail<3>().norm(), 0.03);
  EXPECT_LT(error.head<3>().norm(), 0.01);
  EXPECT_EQ(run.estimator().counts(Module::kLidar).used, 60);
}

/// Bobs and nods as it walks, twice in five sweeps: at the end of a sweep that is taken for steady all of it is wrong.
TEST(Loam, FollowsMotionThatBendsWithinItsSweeps) {
  const testing::BoxWorld room = testing::furnished_room();
  const Motion motion = [](double t) {
    const double set_out = std::clamp(t - 2.0, 0.0, 1.0);
    const double phase = 0.8 * std::numbers::pi * (t - 2.0);
    return Pose{exp_so3({0.0, 0.07 * set_out * std::sin(phase), 0.05 * std::max(0.0, t - 2.0)}),
                {0.2 * std::max(0.0, t - 2.0) - 2.0, 0.0, 0.3 + 0.12 * set_out * std::sin(phase)}};
  };
  LoamRun run(calibration_of(40, 1.0));
  run.follow(room, motion, 15, 4);
  double square_m2 = 0.0;
  double square_rad2 = 0.0;
  for (std::int64_t k = 6; k < 15; ++k) {
    const Vector6d error = run.error(motion, k * 1'000'000'000 + kClock_ns, (k + 1) * 1'000'000'000 + kClock_ns);
    square_rad2 += error.head<3>().squaredNorm() / 9.0;
    square_m2 += error.tail<3>().squaredNorm() / 9.0;
  }
  // Of each second's motion: 8 cm and 2.4 degrees; with sweeps taken for steady 21 cm and 8.3 degrees.
  EXPECT_LT(std::sqrt(square_m2), 0.13);
  EXPECT_LT(std::sqrt(square_rad2), 0.075);
}

/// From rest without an IMU, where nothing but leaves shows the motion: it was missed at first, and then for good.
TEST(Loam, SetsOutAmongLeavesWithoutAnImu) {
  const testing::BoxWorld thicket = testing::thicket(6.0);
  const Motion motion = [](double t) {
    const double since = std::max(0.0, t - 2.0);
    return Pose{exp_so3({0.0, 0.0, 0.05 * std::sin(since)}), {0.5 * since, 0.0, 0.2}};
  };
  LoamRun run(calibration_of(40, 1.0));
  run.follow(thicket, motion, 8, 5);
  const Vector6d error = run.error(motion, 1'100'000'000, 8'010'000'000);
  // Of three metres; a start that is not noticed costs half a metre a second.
  EXPECT_LT(error.tail<3>().norm(), 0.15);
  EXPECT_LT(error.head<3>().norm(), 0.03);
}

TEST(Loam, GivesTheMotionWithinASweep) {
  const testing::BoxWorld room = testing::furnished_room();
  const Motion motion = turning_walk(0.4, 0.1);
  LoamRun run(calibration_of(40, 1.0));
  run.follow(room, motion, 4, 2);
  for (std::int64_t at_ns = 3'000'000'000; at_ns < 3'900'000'000; at_ns += 100'000'000) {
    EXPECT_LT(run.error(motion, at_ns, at_ns + 100'000'000).tail<3>().norm(), 0.04) << at_ns;
  }
}

TEST(Loam, DoesNotRingFromSweepToSweep) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const Motion motion = [](double t) {
    return Pose{exp_so3({0.0, 0.02 * std::sin(3.0 * t), 0.0}), {8.0 * t + 0.75 * t * t, 0.0, 0.5}};
  };
  RandomStream noise(3, "lidar");
  LoamRun run(calibration_of(16, 10.0));
  for (std::int64_t k = 0; k < 20; ++k) run.add(testing::vlp16_scan(hall, motion, k * 100'000'000, {}, 0.012, noise));
  run.wait_until(2'010'000'000);
  // Each step's error stays that of one match; a ringing end pose is off by decimetres, up and down by turns.
  for (std::int64_t k = 5; k < 20; ++k) {
    const Vector6d error = run.error(motion, k * 100'000'000 + kClock_ns, (k + 1) * 100'000'000 + kClock_ns);
    EXPECT_LT(error.tail<3>().norm(), 0.04) << k;
  }
}

/// The other estimators without an IMU. One that took the distortion within a sweep for known rang from sweep to sweep,
/// already at rest, until it was thrown out.
TEST(WithoutAnImu, TheLidarAloneIsFollowed) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const Motion motion = [](double t) {
    return Pose{exp_so3({0.0, 0.02 * std::sin(3.0 * t), 0.0}), {0.75 * t * t, 0.0, 0.5}};
  };
  Calibration blind = calibration_of(16, 10.0);
  Calibration seeing = blind;  // and no image ever comes
  seeing.has_camera = true;
  seeing.camera = {64, 36, 47.0, 47.0, 31.5, 17.5};
  for (const auto& [name, calibration] : {std::pair{"imu_lidar", blind}, {"vloam", blind}, {"vloam", seeing}}) {
    RandomStream noise(3, "lidar");
    LoamRun run(calibration, {}, name);
    for (std::int64_t k = 0; k < 40; ++k) run.add(testing::vlp16_scan(hall, motion, k * 100'000'000, {}, 0.012, noise));
    run.wait_until(4'010'000'000);
    // Twelve metres from rest on. Where images are still waited for, the end is predicted over up to 0.2 s.
    const Vector6d error = run.error(motion, 110'000'000, 3'710'000'000);
    EXPECT_LT(error.tail<3>().norm(), 0.08) << name << ", camera " << calibration.has_camera;
    EXPECT_LT(error.head<3>().norm(), 0.01) << name << ", camera " << calibration.has_camera;
  }
}

/// A pose that every match fixes is known as well after a minute as after a second. One that added up what no image had
/// shown called itself lost in the end.
TEST(WithoutAnImu, MatchesBoundWhatIsNotKnown) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const Motion motion = [](double t) { return Pose{exp_so3({0.0, 0.0, 0.02 * t}), {0.3 * t, 0.0, 0.0}}; };
  for (const char* name : {"demo_matched", "loam"}) {
    Calibration calibration = calibration_of(16, 10.0);
    calibration.has_camera = std::string(name) == "demo_matched";  // and no image ever comes
    calibration.camera = {64, 36, 47.0, 47.0, 31.5, 17.5};
    RandomStream noise(3, "lidar");
    LoamRun run(calibration, {}, name);
    for (std::int64_t k = 0; k < 60; ++k) run.add(testing::vlp16_scan(hall, motion, k * 100'000'000, {}, 0.012, noise));
    run.wait_until(6'010'000'000);
    const Odometry& end = run.newest();
    EXPECT_FALSE(end.lost) << name;
    // A scan that no image leads to is foreseen to 6 cm a direction; 60 of them would add up to 0.7 m^2.
    EXPECT_LT(end.covariance.diagonal().tail(3).sum(), 0.1) << name;
    EXPECT_GT(end.increment_covariance.diagonal().minCoeff(), 0.0) << name;
    const Vector6d error = motion(1e-9 * static_cast<double>(end.stamp_ns)).local(end.world_from_body);
    EXPECT_LT(error.dot(end.covariance.ldlt().solve(error)) / 6.0, 4.0) << name;
  }
}

TEST(WithoutAnImu, WhatNeedsOneIsRefused) {
  EstimatorConfig config;
  config.imu_enabled = false;
  for (const char* name : {"joint", "imu"}) {
    EXPECT_THROW(make_estimator(name, calibration_of(16, 10.0), config), std::invalid_argument) << name;
  }
}

/// A walker's hand swings what it holds: sweeps of a second were taken for steady, and a second's motion thought known
/// five times better than it was.
TEST(SteadyMotion, LearnsHowRestlessItsCarrierIs) {
  const auto bend_after = [](double swing) {
    SteadyMotion motion({}, true);
    for (int sweep = 0; sweep < 20; ++sweep) {
      const double rate = 0.1 + (sweep % 2 == 0 ? swing : -swing);
      motion.follow({}, {exp_so3(Eigen::Vector3d(0.0, rate, 0.0)), Eigen::Vector3d(0.5, 0.0, 0.0)}, 1.0);
    }
    return motion.bend_covariance();
  };
  EXPECT_LT(bend_after(0.0).diagonal().maxCoeff(), 1e-12);
  // Changes of 0.4 rad/s about one of three axes; a linear motion over such a sweep ends an eighth of it off.
  EXPECT_NEAR(std::sqrt(bend_after(0.2)(1, 1)), 0.4 / std::sqrt(3.0) / 8.0, 1e-6);
  EXPECT_GT(bend_after(0.2)(3, 3), 0.0);  // what turns in the hand changes its velocity in B, too
}

TEST(EstimatorSettings, OutOfRangeAreRefused) {
  const Calibration calibration = calibration_of(16, 10.0);
  for (const double share : {0.0, -0.5, 1.5, std::nan("")}) {
    EXPECT_THROW(make_estimator("vloam", calibration, {.feature_share = share}), std::invalid_argument) << share;
  }
  for (const double factor : {0.5, 21.0, std::nan("")}) {
    EXPECT_THROW(make_estimator("vloam", calibration, {.resolution_factor = factor}), std::invalid_argument) << factor;
  }
}

TEST(Loam, TakesSweepsWhoseReturnsBearOneTime) {
  const testing::BoxWorld room = testing::furnished_room();
  RandomStream noise(4, "lidar");
  LoamRun run(calibration_of(16, 10.0));
  for (std::int64_t k = 0; k < 4; ++k) {
    const Motion rest = [k](double) {
      return Pose{exp_so3({0.0, 0.0, 0.02 * static_cast<double>(k)}),
                  {0.3 * static_cast<double>(k), 0.05 * static_cast<double>(k), 0.0}};
    };
    LidarScan scan = testing::vlp16_scan(room, rest, k * 100'000'000, {}, 0.012, noise);
    for (LidarPoint& point : scan.points) point.offset_ns = 0;
    run.add(scan);
  }
  run.wait_until(410'000'000);
  const Motion steady = [](double t) { return Pose{exp_so3({0.0, 0.0, 0.2 * t}), {3.0 * t, 0.5 * t, 0.0}}; };
  const Vector6d error = run.error(steady, 210'000'000, 410'000'000);
  EXPECT_LT(error.tail<3>().norm(), 0.03);
  EXPECT_LT(error.head<3>().norm(), 0.005);
}

TEST(Loam, OutlivesLostParts) {
  const testing::BoxWorld room = testing::furnished_room();
  const Motion motion = turning_walk(0.2, 0.05);
  RandomStream noise(5, "lidar");
  LoamRun run(calibration_of(40, 1.0));
  for (std::int64_t sweep = 0; sweep < 8; ++sweep) {
    const auto parts = testing::turned_scanner_sweep(room, motion, sweep, 0.01, noise);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool lost = (sweep == 3 && i == 9) || (sweep == 4 && i < 3);
      if (!lost) run.add(parts[i]);
    }
  }
  run.wait_until(8'010'000'000);
  EXPECT_LT(run.error(motion, 2'100'000'000, 8'010'000'000).tail<3>().norm(), 0.05);
}

/// At the end of each sweep the scanner sees nothing, or nothing but its carrier. No sweep ever ended.
TEST(Loam, FollowsSweepsWhoseLastPartIsEmpty) {
  const testing::BoxWorld room = testing::furnished_room();
  const Motion motion = turning_walk(0.4, 0.1);
  RandomStream noise(6, "lidar");
  LoamRun run(calibration_of(40, 1.0));
  for (std::int64_t sweep = 0; sweep < 6; ++sweep) {
    auto parts = testing::turned_scanner_sweep(room, motion, sweep, 0.01, noise);
    parts.back().points.clear();
    for (const LidarScan& part : parts) run.add(part);
  }
  run.wait_until(6'010'000'000);
  const Vector6d error = run.error(motion, 2'100'000'000, 5'900'000'000);
  EXPECT_LT(error.tail<3>().norm(), 0.05);
  EXPECT_LT(error.head<3>().norm(), 0.02);
}

/// The first sweep after a silence is laid down where steady motion leads: over four seconds, anywhere within metres.
TEST(Loam, ASilenceIsNotForgottenWithTheFirstSweepAfterIt) {
  const testing::BoxWorld hall = testing::pillared_hall(40.0);
  const Motion motion = [](double t) { return Pose{Eigen::Quaterniond::Identity(), {0.3 * t, 0.0, 0.0}}; };
  RandomStream noise(7, "lidar");
  LoamRun run(calibration_of(16, 10.0));
  const auto add_scan = [&](std::int64_t k) {
    run.add(testing::vlp16_scan(hall, motion, k * 100'000'000, {}, 0.012, noise));
    run.wait_until((k + 1) * 100'000'000 + kClock_ns);
  };
  for (std::int64_t k = 0; k < 10; ++k) add_scan(k);
  EXPECT_LT(run.newest().covariance.diagonal().tail(3).sum(), 0.1);
  add_scan(50);
  EXPECT_GT(run.newest().covariance.diagonal().tail(3).sum(), 0.5);
}

TEST(SweepAssembler, JoinsPartsWithTheirOwnTimes) {
  SweepAssembler assembler;
  LidarScan part;
  part.points.resize(2);
  part.points[1].offset_ns = 70;
  part.sweep = 5;
  for (int i = 0; i < 3; ++i) {
    part.stamp_ns = 1000 + 100 * i;
    part.end_ns = part.stamp_ns + 100;
    part.ends_sweep = i == 2;
    const auto sweep = assembler.add(part);
    ASSERT_EQ(sweep.has_value(), i == 2);
    if (!sweep) continue;
    EXPECT_EQ(sweep->stamp_ns, 1000);
    EXPECT_EQ(sweep->end_ns, 1300);
    ASSERT_EQ(sweep->points.size(), 6U);
    EXPECT_EQ(sweep->points[5].offset_ns, 270);
  }
}

TEST(SweepAssembler, LetsASweepGoWhoseEndNeverComes) {
  SweepAssembler assembler;
  LidarScan part;
  part.points.resize(1);
  part.ends_sweep = false;
  part.end_ns = 100;
  EXPECT_FALSE(assembler.add(part));
  part.sweep = 1;
  part.stamp_ns = 200;
  part.end_ns = 300;
  part.ends_sweep = true;
  const auto sweep = assembler.add(part);
  ASSERT_TRUE(sweep);
  EXPECT_EQ(sweep->stamp_ns, 200);
  EXPECT_EQ(sweep->points.size(), 1U);
}

}  // namespace
}  // namespace plumbline
