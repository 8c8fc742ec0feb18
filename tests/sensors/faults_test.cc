#include "sensors/faults.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline {
namespace {

LidarScan scan_of(int points) {
  LidarScan scan;
  scan.end_ns = 1000;
  for (int i = 0; i < points; ++i) {
    LidarPoint point;
    point.offset_ns = i * 1000 / points;
    scan.points.push_back(point);
  }
  return scan;
}

TEST(Faults, PartialKeepsTheFirstShareOfTheTime) {
  RandomStream stream(1, "test");
  LidarScan scan = scan_of(100);
  spoil(scan, {FaultySensor::kLidar, FaultKind::kPartial, 0.0, 1.0, 1.0, 0.3}, stream);
  ASSERT_EQ(scan.points.size(), 30U);
  EXPECT_LT(scan.points.back().offset_ns, 300);
}

TEST(Faults, NanHitsItsShareOfThePoints) {
  RandomStream stream(1, "test");
  LidarScan scan = scan_of(1000);
  spoil(scan, {FaultySensor::kLidar, FaultKind::kNan, 0.0, 1.0, 1.0, 0.2}, stream);
  int spoilt = 0;
  for (const LidarPoint& point : scan.points) spoilt += point.position.allFinite() ? 0 : 1;
  // Binomial: 200 +- 13; five of those.
  EXPECT_NEAR(spoilt, 200, 65);
}

TEST(Faults, BlackAndSaturatedFillTheUpperRows) {
  RandomStream stream(1, "test");
  CameraFrame frame{0, 0, 4, 4, std::vector<std::uint8_t>(16, 100)};
  spoil(frame, {FaultySensor::kCamera, FaultKind::kSaturated, 0.0, 1.0, 1.0, 0.5}, stream);
  EXPECT_EQ(frame.pixels[7], 255);
  EXPECT_EQ(frame.pixels[8], 100);
  spoil(frame, {FaultySensor::kCamera, FaultKind::kBlack, 0.0, 1.0, 1.0, 1.0}, stream);
  EXPECT_EQ(frame.pixels[15], 0);
}

TEST(FaultTrigger, HitsWithinItsTimeAtItsProbabilityTheSameForOneSeed) {
  const Fault fault{FaultySensor::kImu, FaultKind::kDropOut, 1.0, 6.0, 0.25, 1.0};
  FaultTrigger first(fault, 3, 0);
  FaultTrigger second(fault, 3, 0);
  int hits = 0;
  for (std::int64_t t = 0; t < 10'000'000'000; t += 5'000'000) {
    const bool hit = first.hits(t);
    EXPECT_EQ(hit, second.hits(t));
    EXPECT_TRUE(!hit || (t >= 1'000'000'000 && t < 6'000'000'000));
    hits += hit ? 1 : 0;
  }
  // 1000 trials: 250 +- 14; five of those.
  EXPECT_NEAR(hits, 250, 70);
}

TEST(Faults, FreezeKeepsTheNewStamps) {
  ImuSample sample;
  sample.stamp_ns = 7;
  ImuSample earlier;
  earlier.angular_rate.setConstant(2.0);
  freeze(sample, earlier);
  EXPECT_EQ(sample.stamp_ns, 7);
  EXPECT_EQ(sample.angular_rate.x(), 2.0);
}

}  // namespace
}  // namespace plumbline
