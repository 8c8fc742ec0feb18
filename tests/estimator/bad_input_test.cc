#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "estimator/estimator.h"
#include "tests/support/box_world.h"

/// A property: whatever mixture of bad messages comes, nothing throws, every message is counted, all outputs are
/// finite, and when the data are good again the estimate is, too.
namespace plumbline {
namespace {

constexpr std::int64_t kImuPeriod_ns = 5'000'000;
constexpr std::int64_t kFramePeriod_ns = 50'000'000;
constexpr std::int64_t kScanPeriod_ns = 100'000'000;
constexpr std::int64_t kBadFrom_ns = 2'000'000'000;
constexpr std::int64_t kGoodFrom_ns = 5'000'000'000;
constexpr std::int64_t kEnd_ns = 7'000'000'000;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Calibration small_calibration() {
  Calibration calibration;
  calibration.camera = {64, 36, 47.0, 47.0, 31.5, 17.5};
  return calibration;
}

bool chance(RandomStream& draw, double probability) { return draw.uniform() < probability; }

std::int64_t wild_stamp(std::int64_t stamp_ns, RandomStream& draw) {
  if (chance(draw, 0.1)) return std::numeric_limits<std::int64_t>::max();
  if (chance(draw, 0.1)) return std::numeric_limits<std::int64_t>::min();
  return stamp_ns + static_cast<std::int64_t>(draw.uniform(-4e9, 4e9));
}

void spoil(ImuSample& sample, RandomStream& draw) {
  if (chance(draw, 0.3)) sample.angular_rate.x() = kNaN;
  if (chance(draw, 0.3)) sample.specific_force.y() = kInfinity;
  if (chance(draw, 0.2)) sample.specific_force.z() = 1e300;
  // Never ahead: a clock that runs ahead and stays there is followed.
  if (chance(draw, 0.3)) sample.stamp_ns -= static_cast<std::int64_t>(draw.uniform(0.0, 3e9));
}

void spoil(CameraFrame& frame, RandomStream& draw) {
  if (chance(draw, 0.3)) frame.width = 65;
  if (chance(draw, 0.3)) frame.pixels.resize(static_cast<std::size_t>(draw.uniform(0.0, 5000.0)));
  if (chance(draw, 0.3)) frame.pixels.assign(frame.pixels.size(), 0);
  if (chance(draw, 0.3)) frame.stamp_ns = wild_stamp(frame.stamp_ns, draw);
}

void spoil(LidarScan& scan, RandomStream& draw) {
  if (chance(draw, 0.2)) scan.points.clear();
  if (chance(draw, 0.3)) {
    for (LidarPoint& point : scan.points) point.ring = 3;
  }
  if (chance(draw, 0.3)) {
    for (LidarPoint& point : scan.points) point.offset_ns = static_cast<std::int32_t>(draw.uniform(-2e9, 2e9));
  }
  for (LidarPoint& point : scan.points) {
    if (chance(draw, 0.1)) point.position.x() = chance(draw, 0.5) ? kNaN : kInfinity;
    if (chance(draw, 0.05)) point.position.setConstant(1e30F);
    if (chance(draw, 0.05)) point.position.setZero();
    if (chance(draw, 0.05)) point.ring = 60000;
  }
  if (chance(draw, 0.2)) scan.end_ns = wild_stamp(scan.end_ns, draw);
  if (chance(draw, 0.2)) scan.stamp_ns = wild_stamp(scan.stamp_ns, draw);
}

std::int64_t sum_of(const MessageCounts& counts) {
  std::int64_t sum = counts.used;
  for (const auto& [reason, count] : counts.dropped) sum += count;
  return sum;
}

class Feed {
 public:
  explicit Feed(std::uint64_t seed)
      : draw_(seed, "bad"), noise_(seed, "lidar"), estimator_(make_estimator("vloam", small_calibration(), {})) {}

  /// A sensor that is missing is so from the start or from any moment on.
  void run(bool imu_gap, std::int64_t camera_until_ns, std::int64_t lidar_until_ns) {
    for (std::int64_t t = kImuPeriod_ns; t <= kEnd_ns; t += kImuPeriod_ns) {
      const bool gap = imu_gap && t > 3'000'000'000 && t <= 5'000'000'000;
      if (!gap) imu(t);
      if (t % kFramePeriod_ns == 0 && t < camera_until_ns) frame(t);
      if (t % kScanPeriod_ns == 0 && t < lidar_until_ns) scan(t);
    }
  }

  void expect_sound(bool has_lidar) {
    const auto outputs = estimator_->take();
    ASSERT_FALSE(outputs.empty());
    for (const Odometry& o : outputs) {
      ASSERT_TRUE(o.world_from_body.translation.allFinite() && o.world_from_body.rotation.coeffs().allFinite());
      ASSERT_TRUE(o.velocity_in_world.allFinite());
    }
    EXPECT_EQ(sum_of(estimator_->counts(Module::kImu)), sent_[0]);
    EXPECT_EQ(sum_of(estimator_->counts(Module::kVision)), sent_[1]);
    EXPECT_EQ(sum_of(estimator_->counts(Module::kLidar)), sent_[2]);
    EXPECT_EQ(outputs.back().stamp_ns, kEnd_ns);
    // Nothing has moved. Two good seconds of scans bring the estimate back to the room; without them it drifts as the
    // IMU does.
    if (has_lidar) {
      EXPECT_LT(outputs.back().world_from_body.translation.norm(), 0.1);
    }
  }

 private:
  bool bad(std::int64_t t) { return t > kBadFrom_ns && t < kGoodFrom_ns && chance(draw_, 0.5); }

  void imu(std::int64_t t) {
    ImuSample sample;
    sample.stamp_ns = t;
    sample.specific_force = {0.002 * noise_.gaussian(), 0.002 * noise_.gaussian(), 9.81};
    if (bad(t)) spoil(sample, draw_);
    estimator_->add(sample);
    ++sent_[0];
  }

  void frame(std::int64_t t) {
    CameraFrame image{t, 0, 64, 36, std::vector<std::uint8_t>(64 * 36)};
    for (std::uint8_t& pixel : image.pixels) pixel = static_cast<std::uint8_t>(draw_.uniform(90.0, 110.0));
    if (bad(t)) spoil(image, draw_);
    estimator_->add(image);
    ++sent_[1];
  }

  void scan(std::int64_t t) {
    LidarScan points = testing::vlp16_scan(
        room_,
        [](double) {
          return Pose{Eigen::Quaterniond::Identity(), {1.0, 0.5, 0.3}};
        },
        t - kScanPeriod_ns, {}, 0.01, noise_);
    if (bad(t)) spoil(points, draw_);
    estimator_->add(points);
    ++sent_[2];
  }

  RandomStream draw_;
  RandomStream noise_;
  testing::BoxWorld room_ = testing::furnished_room();
  std::unique_ptr<Estimator> estimator_;
  std::array<std::int64_t, 3> sent_{};
};

TEST(BadInput, AnyMixtureIsCountedAndRecoveredFrom) {
  constexpr std::int64_t kAlways = kEnd_ns + 1;
  struct Case {
    bool imu_gap;
    std::int64_t camera_until_ns;
    std::int64_t lidar_until_ns;
  };
  const std::vector<Case> cases{{false, kAlways, kAlways},      {true, kAlways, kAlways}, {false, 0, kAlways},
                                {true, 3'300'000'000, kAlways}, {false, kAlways, 0},      {false, 0, 2'700'000'000}};
  std::uint64_t seed = 0;
  for (const Case& c : cases) {
    SCOPED_TRACE(++seed);
    Feed feed(seed);
    ASSERT_NO_THROW(feed.run(c.imu_gap, c.camera_until_ns, c.lidar_until_ns));
    feed.expect_sound(c.lidar_until_ns == kAlways);
  }
}

}  // namespace
}  // namespace plumbline
