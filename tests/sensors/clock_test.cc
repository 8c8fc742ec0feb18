#include "sensors/clock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline {
namespace {

TEST(SensorClock, PerfectChangesNothing) {
  SensorClock clock({}, 1, "lidar");
  LidarScan scan;
  scan.stamp_ns = 123'456'789'012'345;
  scan.end_ns = scan.stamp_ns + 100'000'000;
  scan.points.resize(1);
  scan.points[0].offset_ns = 77;
  clock.restamp(scan);
  EXPECT_EQ(scan.stamp_ns, 123'456'789'012'345);
  EXPECT_EQ(scan.end_ns, 123'456'889'012'345);
  EXPECT_EQ(scan.points[0].offset_ns, 77);
}

TEST(SensorClock, IsAheadByItsOffsetAndRunsFastByItsDrift) {
  SensorClock clock({0.005, 100e-6, 0.0}, 1, "imu");
  ImuSample sample;
  sample.stamp_ns = 10'000'000'000;
  clock.restamp(sample);
  EXPECT_EQ(sample.stamp_ns, 10'000'000'000 + 5'000'000 + 1'000'000);
}

TEST(SensorClock, JittersByItsSigmaAndShiftsAScanAsAWhole) {
  SensorClock clock({0.0, 0.0, 1e-4}, 1, "lidar");
  double square_sum = 0.0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    LidarScan scan;
    scan.end_ns = 100'000'000;
    clock.restamp(scan);
    EXPECT_EQ(scan.end_ns - scan.stamp_ns, 100'000'000);
    square_sum += std::pow(static_cast<double>(scan.stamp_ns) * 1e-9, 2);
  }
  // 2000 draws: the standard deviation's own relative error is 1.6 %; five of those.
  EXPECT_NEAR(std::sqrt(square_sum / n), 1e-4, 0.08e-4);
}

TEST(Transport, DelaysWithoutOvertaking) {
  Transport transport({0.02, 0.01}, 1, "camera");
  std::int64_t last = 0;
  for (std::int64_t sent = 0; sent < 1'000'000'000; sent += 5'000'000) {
    const std::int64_t arrival = transport.arrival_ns(sent);
    EXPECT_GE(arrival, sent + 20'000'000);
    EXPECT_GE(arrival, last);
    last = arrival;
  }
}

}  // namespace
}  // namespace plumbline
