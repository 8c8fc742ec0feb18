#include "estimator/pipeline/message_gate.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

MessageUse everything() {
  MessageUse use;
  use.cameras[0] = {4, 2};
  use.cameras[3] = {2, 2};
  use.depth_cameras[5] = {2, 2};
  use.lidar = true;
  return use;
}

ImuSample sample_at(std::int64_t stamp_ns) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  sample.specific_force = {0.0, 0.0, 9.81};
  return sample;
}

CameraFrame frame_at(std::int64_t stamp_ns, std::uint8_t grey) {
  return {stamp_ns, 0, 4, 2, std::vector<std::uint8_t>(8, grey)};
}

LidarScan scan_until(std::int64_t end_ns, float x = 1.0F) {
  LidarScan scan;
  scan.stamp_ns = end_ns - 100 * kMillisecond;
  scan.end_ns = end_ns;
  scan.points.resize(3);
  for (LidarPoint& point : scan.points) point.position = {x, 2.0F, 3.0F};
  return scan;
}

/// A gate that has seen IMU samples up to a time.
MessageGate gate_at(std::int64_t stamp_ns, MessageUse use = everything()) {
  MessageGate gate(std::move(use));
  EXPECT_TRUE(gate.admit(sample_at(stamp_ns)));
  return gate;
}

TEST(MessageGate, HandsOutInOrderOfStampsOnceTheImuIsThere) {
  MessageGate gate = gate_at(kSecond);
  gate.admit(scan_until(kSecond + 30 * kMillisecond));
  gate.admit(frame_at(kSecond + 20 * kMillisecond, 1));
  gate.admit(DepthFrame{kSecond + 20 * kMillisecond, 5, 2, 2, {1.0F, 2.0F, 0.0F, 4.0F}});
  EXPECT_FALSE(gate.next(kSecond + 19 * kMillisecond));
  const auto first = gate.next(kSecond + 30 * kMillisecond);
  const auto second = gate.next(kSecond + 30 * kMillisecond);
  const auto third = gate.next(kSecond + 30 * kMillisecond);
  ASSERT_TRUE(first && second && third);
  EXPECT_TRUE(std::holds_alternative<CameraFrame>(*first));
  EXPECT_TRUE(std::holds_alternative<DepthFrame>(*second));
  EXPECT_TRUE(std::holds_alternative<LidarScan>(*third));
  EXPECT_EQ(stamp_of(*third), kSecond + 30 * kMillisecond);
  EXPECT_FALSE(gate.next(10 * kSecond));
}

TEST(MessageGate, DropsSamplesThatCannotBe) {
  MessageGate gate = gate_at(kSecond);
  ImuSample bad = sample_at(kSecond + kMillisecond);
  bad.specific_force.y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(gate.admit(bad));
  bad.specific_force.y() = 1e100;
  EXPECT_FALSE(gate.admit(bad));
  EXPECT_FALSE(gate.admit(sample_at(kSecond)));
  EXPECT_FALSE(gate.admit(sample_at(std::numeric_limits<std::int64_t>::min())));
  const MessageCounts counts = gate.counts(Module::kImu);
  EXPECT_EQ(counts.used, 1);
  EXPECT_EQ(counts.dropped.at("not finite"), 1);
  EXPECT_EQ(counts.dropped.at("out of range"), 2);
  EXPECT_EQ(counts.dropped.at("back in time"), 1);
}

TEST(MessageGate, OneStampFarAheadDoesNotStopTheClock) {
  MessageGate gate = gate_at(kSecond);
  EXPECT_FALSE(gate.admit(sample_at(3600 * kSecond)));
  EXPECT_EQ(gate.counts(Module::kImu).dropped.at("ahead of time"), 1);
  EXPECT_TRUE(gate.admit(sample_at(kSecond + 5 * kMillisecond)));
}

TEST(MessageGate, AClockThatStaysAheadIsFollowed) {
  MessageGate gate = gate_at(kSecond);
  int refused = 0;
  std::int64_t stamp_ns = 3600 * kSecond;
  while (!gate.admit(sample_at(stamp_ns += 5 * kMillisecond))) ++refused;
  EXPECT_EQ(refused, MessageGate::kAgreeing - 1);
}

TEST(MessageGate, AGapOfTwoSecondsIsNoLeap) {
  MessageGate gate = gate_at(kSecond);
  gate.admit(frame_at(kSecond + 1500 * kMillisecond, 1));
  EXPECT_TRUE(gate.admit(sample_at(3 * kSecond)));
  EXPECT_TRUE(gate.next(3 * kSecond));
}

TEST(MessageGate, WithoutAnImuSamplesAreAClock) {
  MessageUse use = everything();
  use.imu = false;
  MessageGate gate(use);
  ImuSample sample = sample_at(kSecond);
  sample.angular_rate.x() = std::numeric_limits<double>::quiet_NaN();
  const auto taken = gate.admit(sample);
  ASSERT_TRUE(taken);
  EXPECT_TRUE(taken->angular_rate.isZero());
  EXPECT_TRUE(taken->specific_force.isZero());
}

TEST(MessageGate, CountsImagesItCannotUse) {
  MessageGate gate(everything());
  gate.admit(frame_at(kSecond, 1));
  ASSERT_TRUE(gate.admit(sample_at(kSecond)));
  gate.admit(frame_at(kSecond, 1));
  gate.admit(frame_at(kSecond + 10 * kMillisecond, 1));
  gate.admit(frame_at(kSecond - 10 * kMillisecond, 2));
  gate.admit(frame_at(kSecond - 600 * kMillisecond, 2));
  gate.admit(frame_at(kSecond + 4 * kSecond, 2));
  gate.admit(CameraFrame{kSecond, 3, 4, 2, std::vector<std::uint8_t>(8)});
  gate.admit(CameraFrame{kSecond, 0, 4, 2, std::vector<std::uint8_t>(7)});
  gate.admit(CameraFrame{kSecond, 9, 4, 2, std::vector<std::uint8_t>(8)});
  gate.admit(DepthFrame{kSecond, 0, 4, 2, std::vector<float>(8)});
  gate.admit(DepthFrame{kSecond, 5, 4, 2, std::vector<float>(8)});
  const auto dropped = gate.counts(Module::kVision).dropped;
  EXPECT_EQ(dropped.at("before the start"), 1);
  EXPECT_EQ(dropped.at("repeats the last"), 1);
  EXPECT_EQ(dropped.at("back in time"), 1);
  EXPECT_EQ(dropped.at("late"), 1);
  EXPECT_EQ(dropped.at("no IMU to go with"), 1);
  EXPECT_EQ(dropped.at("wrong size"), 3);
  EXPECT_EQ(dropped.at("further cameras are not used"), 1);
  EXPECT_EQ(dropped.at("depth images are not used"), 1);
}

TEST(MessageGate, CountsScansItCannotUse) {
  MessageGate gate = gate_at(kSecond);
  gate.admit(LidarScan{});
  LidarScan backwards = scan_until(kSecond);
  std::swap(backwards.stamp_ns, backwards.end_ns);
  gate.admit(backwards);
  LidarScan long_one = scan_until(kSecond);
  long_one.stamp_ns = std::numeric_limits<std::int64_t>::min();
  gate.admit(long_one);
  LidarScan infinite = scan_until(kSecond, std::numeric_limits<float>::infinity());
  gate.admit(infinite);
  gate.admit(scan_until(kSecond));
  gate.admit(scan_until(kSecond + 100 * kMillisecond));
  const auto dropped = gate.counts(Module::kLidar).dropped;
  EXPECT_EQ(dropped.at("empty"), 1);
  EXPECT_EQ(dropped.at("back in time"), 1);
  EXPECT_EQ(dropped.at("too long"), 1);
  EXPECT_EQ(dropped.at("not finite"), 1);
  EXPECT_EQ(dropped.at("repeats the last"), 1);
  EXPECT_TRUE(gate.next(kSecond));
}

TEST(MessageGate, LeavesReturnsOutThatCannotBe) {
  MessageGate gate = gate_at(kSecond);
  LidarScan scan = scan_until(kSecond);
  scan.points[1].position.x() = std::numeric_limits<float>::quiet_NaN();
  scan.points[2].position.x() = 1e30F;
  gate.admit(scan);
  const auto message = gate.next(kSecond);
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<LidarScan>(*message).points.size(), 1u);
}

/// What carries the lidar moves with it: matched, its returns would say that nothing moves.
TEST(MessageGate, LeavesReturnsFromTheCarrierOut) {
  Calibration calibration;
  calibration.body_from_lidar = {exp_so3({0.0, 0.0, std::numbers::pi / 2.0}), {0.0, 0.0, 1.0}};
  calibration.own_body = {{{exp_so3({0.0, 0.0, 0.5}), {0.0, 0.4, 0.9}}, {0.1, 0.2, 0.3}}};
  MessageGate gate = gate_at(kSecond, message_use(calibration, {}));
  LidarScan scan = scan_until(kSecond);
  scan.points.resize(3);
  scan.points[0].position = {0.4F, 0.0F, -0.1F};   // the lidar's x axis is the body's y axis
  scan.points[1].position = {0.4F, 0.0F, -0.6F};   // below it
  scan.points[2].position = {-0.4F, 0.0F, -0.1F};  // on the other side
  gate.admit(scan);
  const auto message = gate.next(kSecond);
  ASSERT_TRUE(message);
  const std::vector<LidarPoint>& left = std::get<LidarScan>(*message).points;
  ASSERT_EQ(left.size(), 2U);
  EXPECT_EQ(left[0].position, scan.points[1].position);
  LidarScan later = scan_until(kSecond + 100 * kMillisecond);
  later.points.assign(1, scan.points[0]);
  gate.admit(later);
  EXPECT_EQ(gate.counts(Module::kLidar).dropped.at("nothing seen"), 1);
}

/// A part of which nothing is left still tells that its sweep is whole.
TEST(MessageGate, HandsAPartWithoutAFiniteReturnOnThatEndsItsSweep) {
  MessageGate gate = gate_at(kSecond);
  LidarScan part = scan_until(kSecond);
  part.ends_sweep = false;
  gate.admit(part);
  LidarScan end = scan_until(kSecond + 100 * kMillisecond);
  for (LidarPoint& point : end.points) point.position.x() = std::numeric_limits<float>::quiet_NaN();
  gate.admit(end);
  ASSERT_TRUE(gate.next(kSecond + 100 * kMillisecond));
  const auto handed_on = gate.next(kSecond + 100 * kMillisecond);
  ASSERT_TRUE(handed_on);
  EXPECT_TRUE(std::get<LidarScan>(*handed_on).ends_sweep);
  EXPECT_TRUE(std::get<LidarScan>(*handed_on).points.empty());
}

TEST(MessageGate, HandsAnEmptyPartOnThatEndsItsSweep) {
  MessageGate gate = gate_at(kSecond);
  LidarScan part = scan_until(kSecond);
  part.ends_sweep = false;
  part.sweep = 4;
  gate.admit(part);
  LidarScan empty = scan_until(kSecond + 100 * kMillisecond);
  empty.points.clear();
  empty.sweep = 4;
  gate.admit(empty);
  ASSERT_TRUE(gate.next(kSecond + 100 * kMillisecond));
  const auto end = gate.next(kSecond + 100 * kMillisecond);
  ASSERT_TRUE(end);
  EXPECT_TRUE(std::get<LidarScan>(*end).ends_sweep);
  // Once it has ended, and where it never began, an empty part says nothing.
  empty.stamp_ns += 100 * kMillisecond;
  empty.end_ns += 100 * kMillisecond;
  gate.admit(empty);
  EXPECT_EQ(gate.counts(Module::kLidar).dropped.at("empty"), 1);
}

TEST(MessageGate, WhatWasMeasuredBeforeTheStartIsDropped) {
  MessageGate gate = gate_at(kSecond);
  gate.admit(frame_at(kSecond + 10 * kMillisecond, 1));
  gate.admit(frame_at(kSecond + 30 * kMillisecond, 2));
  gate.start_at(kSecond + 20 * kMillisecond);
  EXPECT_EQ(gate.counts(Module::kVision).dropped.at("before the start"), 1);
  EXPECT_TRUE(gate.next(kSecond + 30 * kMillisecond));
}

TEST(MessageGate, HoldsNoMoreThanItCanRemember) {
  MessageGate gate = gate_at(kSecond);
  for (int k = 0; k < 300; ++k) gate.admit(frame_at(kSecond + k * kMillisecond, static_cast<std::uint8_t>(k)));
  EXPECT_EQ(gate.counts(Module::kVision).dropped.at("no IMU to go with"),
            300 - static_cast<int>(MessageGate::kMostWaiting));
}

TEST(MessageGate, WithoutCameraOrLidarTheirMessagesAreDisabled) {
  MessageGate gate = gate_at(kSecond, MessageUse{});
  gate.admit(frame_at(kSecond, 1));
  gate.admit(scan_until(kSecond));
  EXPECT_EQ(gate.counts(Module::kVision).dropped.at("disabled"), 1);
  EXPECT_EQ(gate.counts(Module::kLidar).dropped.at("disabled"), 1);
}

}  // namespace
}  // namespace plumbline
