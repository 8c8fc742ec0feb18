#include "scenarios/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "estimator/lidar/own_body_mask.h"
#include "scenarios/calibration.h"
#include "tests/scenarios/body_trajectory.h"
#include "tests/scenarios/room.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

constexpr char kScenario[] = R"(
world: {mjcf: room.xml}
motion: {rest_s: 0, speed_mps: 1, smoothing_s: 0.4, waypoints: [[0, 0, 1], [1, 0, 1], [1, 1, 1]], gait: {frequency_hz: 2}}
rig:
  pitch_deg: 5
  z_m: 0.3
  camera: {width: 96, height: 64}
estimator: {name: imu}
)";

/// Notes the bytes of all it is given, and answers every IMU sample with the pose of standing still.
class RecordingEstimator : public Estimator {
 public:
  struct Message {
    Module module = Module::kImu;
    std::int64_t delivery_ns = 0;
    std::string bytes;
  };

  void add(const ImuSample& sample) override {
    Message& message = note(Module::kImu, sample.stamp_ns);
    for (int axis = 0; axis < 3; ++axis) {
      append(message.bytes, sample.angular_rate[axis]);
      append(message.bytes, sample.specific_force[axis]);
    }
    pending_.push_back({});
    pending_.back().stamp_ns = sample.stamp_ns;
    if (messages.size() >= throw_after) throw std::runtime_error("out of spirits");
  }
  void add(const CameraFrame& frame) override {
    note(Module::kVision, frame.stamp_ns).bytes.assign(frame.pixels.begin(), frame.pixels.end());
  }
  void add(const DepthFrame& /*frame*/) override {}
  void add(const LidarScan& scan) override {
    Message& message = note(Module::kLidar, scan.end_ns);
    append(message.bytes, scan.stamp_ns);
    for (const auto& point : scan.points) {
      for (const float coordinate : point.position) append(message.bytes, coordinate);
      append(message.bytes, point.offset_ns);
      append(message.bytes, point.ring);
      append(message.bytes, point.intensity);
    }
  }
  std::vector<Odometry> take() override { return std::exchange(pending_, {}); }
  MessageCounts counts(Module module) const override { return {used_.at(static_cast<std::size_t>(module)), {}}; }
  std::vector<MapPoint> map() const override { return std::vector<MapPoint>(3); }

  std::vector<Message> messages;
  std::size_t throw_after = std::numeric_limits<std::size_t>::max();

 private:
  template <typename T>
  static void append(std::string& bytes, const T& value) {
    const auto size = bytes.size();
    bytes.resize(size + sizeof(T));
    std::memcpy(bytes.data() + size, &value, sizeof(T));
  }
  Message& note(Module module, std::int64_t delivery_ns) {
    ++used_.at(static_cast<std::size_t>(module));
    return messages.emplace_back(Message{module, delivery_ns, ""});
  }

  std::vector<Odometry> pending_;
  std::array<std::int64_t, 3> used_{};
};

class Session : public ::testing::Test {
 protected:
  Scenario load(const std::vector<std::string>& overrides = {}) const {
    files_.write("room.xml", kRoom);
    return load_scenario(files_.write("mini.yaml", kScenario), overrides, {});
  }

  static RunRecord run(const Scenario& scenario, int threads, Estimator& estimator) {
    const World world = make_world(scenario);
    const RayScene rays(world);
    SessionOptions options;
    options.threads = threads;
    return run_session(scenario, world, rays, options, estimator);
  }

  TemporaryDirectory files_;
};

std::vector<RecordingEstimator::Message> of(Module module, const std::vector<RecordingEstimator::Message>& all) {
  std::vector<RecordingEstimator::Message> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](const auto& m) { return m.module == module; });
  return some;
}

void expect_same_messages(const std::vector<RecordingEstimator::Message>& one,
                          const std::vector<RecordingEstimator::Message>& two) {
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].module, two[i].module) << i;
    ASSERT_EQ(one[i].delivery_ns, two[i].delivery_ns) << i;
    ASSERT_TRUE(one[i].bytes == two[i].bytes) << "message " << i;
  }
}

TEST_F(Session, GivesTheSameBytesWhateverTheNumberOfThreads) {
  const Scenario scenario = load();
  RecordingEstimator in_turn;
  RecordingEstimator ahead;
  const RunRecord one = run(scenario, 1, in_turn);
  const RunRecord two = run(scenario, 2, ahead);
  ASSERT_GT(in_turn.messages.size(), 600U);
  expect_same_messages(in_turn.messages, ahead.messages);
  ASSERT_EQ(one.ground_truth.size(), two.ground_truth.size());
  for (std::size_t i = 0; i < one.ground_truth.size(); ++i) {
    EXPECT_EQ(one.ground_truth[i].pose.translation, two.ground_truth[i].pose.translation);
  }
}

TEST_F(Session, DeliversInOrderWithTheImuFirst) {
  // At 25 Hz the frames' stamps, 20 ms and so on, fall on IMU stamps, and at 10 Hz a scan ends on one, too.
  const Scenario scenario = load({"rig.camera.rate_hz=25"});
  RecordingEstimator estimator;
  run(scenario, 1, estimator);
  const auto& all = estimator.messages;
  for (std::size_t i = 1; i < all.size(); ++i) {
    ASSERT_GE(all[i].delivery_ns, all[i - 1].delivery_ns);
    if (all[i].delivery_ns == all[i - 1].delivery_ns) {
      EXPECT_LT(static_cast<int>(all[i - 1].module), static_cast<int>(all[i].module)) << all[i].delivery_ns;
    }
  }
  EXPECT_EQ(of(Module::kImu, all).front().delivery_ns, 5'000'000);
  EXPECT_EQ(of(Module::kVision, all).front().delivery_ns, 20'000'000);
}

TEST_F(Session, GivesTheSameBytesWithEveryKindOfTroubleOnTheWay) {
  const Scenario scenario = load(
      {"rig.imu.clock={offset_ms: 3, drift_ppm: 50, jitter_us: 40}", "rig.lidar.clock.jitter_us=100",
       "rig.camera.delay_ms=12", "rig.camera.delay_jitter_ms=20", "rig.lidar.delay_jitter_ms=30",
       "rig.imu.delay_jitter_ms=2",
       "faults=[{sensor: imu, kind: nan, start_s: 0.2, end_s: 2, probability: 0.2}, {sensor: imu, kind: reorder, "
       "start_s: 0.2, end_s: 2, probability: 0.2}, {sensor: camera, kind: freeze, start_s: 0.5, end_s: 1, probability: "
       "0.5}, {sensor: camera, kind: drop_out, start_s: 1, end_s: 2, probability: 0.5}, {sensor: lidar, kind: "
       "duplicate, start_s: 0, end_s: 2, probability: 0.5}, {sensor: lidar, kind: partial, start_s: 0, end_s: 2, "
       "probability: 0.5}]"});
  RecordingEstimator in_turn;
  RecordingEstimator ahead;
  run(scenario, 1, in_turn);
  run(scenario, 2, ahead);
  expect_same_messages(in_turn.messages, ahead.messages);
  RecordingEstimator untroubled;
  run(load(), 2, untroubled);
  EXPECT_GT(of(Module::kLidar, in_turn.messages).size(), of(Module::kLidar, untroubled.messages).size());
  EXPECT_LT(of(Module::kVision, in_turn.messages).size(), of(Module::kVision, untroubled.messages).size());
}

TEST_F(Session, DeliversInOrderOfArrivalWhateverTheSensorsDelays) {
  const Scenario scenario = load({"rig.imu.delay_ms=5", "rig.camera.delay_ms=18", "rig.lidar.delay_ms=43"});
  RecordingEstimator estimator;
  run(scenario, 2, estimator);
  const auto arrival_ns = [](const RecordingEstimator::Message& message) {
    constexpr std::array<std::int64_t, 3> kDelay_ns{5'000'000, 18'000'000, 43'000'000};  // IMU, vision, lidar
    return message.delivery_ns + kDelay_ns.at(static_cast<std::size_t>(message.module));
  };
  const auto& all = estimator.messages;
  int older_than_the_one_before = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    ASSERT_GE(arrival_ns(all[i]), arrival_ns(all[i - 1])) << i;
    if (all[i].delivery_ns < all[i - 1].delivery_ns) ++older_than_the_one_before;
  }
  // Every scan and nearly every frame comes after IMU samples that were measured later.
  EXPECT_GT(older_than_the_one_before, 50);
}

TEST_F(Session, KeepsTheTruthAndOneEstimatePerImuSample) {
  const Scenario scenario = load();
  RecordingEstimator estimator;
  const RunRecord record = run(scenario, 2, estimator);
  const Trajectory truth = body_trajectory(scenario);
  EXPECT_EQ(record.ground_truth.size(), static_cast<std::size_t>(truth.end_ns() / 5'000'000));
  EXPECT_EQ(record.estimate.size(), record.ground_truth.size());
  EXPECT_EQ(record.odometry.size(), record.ground_truth.size());
  EXPECT_EQ(record.ground_truth.front().stamp_ns, 5'000'000);
  EXPECT_EQ(record.timing.size(), estimator.messages.size());
  EXPECT_EQ(record.snapshots.size(), 3U);
  EXPECT_EQ(record.map.size(), 3U);
  EXPECT_TRUE(record.fault.empty());
  for (const Module module : {Module::kImu, Module::kVision, Module::kLidar}) {
    const auto count = static_cast<std::int64_t>(of(module, estimator.messages).size());
    EXPECT_EQ(record.messages.at(module).produced, count);
    EXPECT_EQ(record.messages.at(module).used, count);
  }
}

TEST_F(Session, MovesThePackOnTheVehicle) {
  const Scenario scenario = load();
  const Pose start = body_trajectory(scenario).pose(0);
  EXPECT_TRUE(start.translation.isApprox(Eigen::Vector3d(0, 0, 1.3), 1e-9));
  EXPECT_NEAR(rpy_from_rotation(start.rotation).y(), 5.0 * M_PI / 180.0, 1e-9);
}

TEST_F(Session, DecimationDropsEveryOtherMessageAndChangesNoOther) {
  RecordingEstimator all;
  RecordingEstimator half;
  const RunRecord full = run(load({"rig.camera.noise=false"}), 1, all);
  const RunRecord thinned = run(load({"rig.camera.noise=false", "rig.decimation=2"}), 1, half);
  EXPECT_EQ(full.ground_truth.size(), thinned.ground_truth.size());
  for (const Module module : {Module::kImu, Module::kVision, Module::kLidar}) {
    EXPECT_NEAR(static_cast<double>(of(module, half.messages).size()),
                0.5 * static_cast<double>(of(module, all.messages).size()), 0.51);
  }
  const auto full_scans = of(Module::kLidar, all.messages);
  const auto half_scans = of(Module::kLidar, half.messages);
  EXPECT_TRUE(full_scans.at(2).bytes == half_scans.at(1).bytes);
  const auto full_imu = of(Module::kImu, all.messages);
  const auto half_imu = of(Module::kImu, half.messages);
  EXPECT_TRUE(full_imu.at(3).bytes == half_imu.at(1).bytes);
}

TEST_F(Session, EndsInOrderWhenTheEstimatorThrows) {
  for (const int threads : {1, 2}) {
    RecordingEstimator estimator;
    estimator.throw_after = 50;
    const RunRecord record = run(load(), threads, estimator);
    EXPECT_THAT(record.fault, HasSubstr("out of spirits"));
    EXPECT_LT(estimator.messages.size(), 60U);
    EXPECT_FALSE(record.ground_truth.empty());
  }
}

TEST_F(Session, DrivesSeveralEstimatorsAsIfEachWereAlone) {
  const Scenario scenario = load();
  const World world = make_world(scenario);
  const RayScene rays(world);
  RecordingEstimator alone;
  const RunRecord expected = run(scenario, 1, alone);
  RecordingEstimator failing;
  failing.throw_after = 50;
  RecordingEstimator other;
  const std::vector<RunRecord> records =
      run_session(scenario, world, rays, {}, std::vector<Estimator*>{&failing, &other});
  ASSERT_EQ(records.size(), 2U);
  EXPECT_THAT(records[0].fault, HasSubstr("out of spirits"));
  EXPECT_LT(failing.messages.size(), 60U);
  EXPECT_EQ(records[1].fault, "");
  EXPECT_EQ(records[1].estimate.size(), expected.estimate.size());
  expect_same_messages(other.messages, alone.messages);
}

TEST_F(Session, EndsInOrderWhenItIsToldTo) {
  const Scenario scenario = load();
  const World world = make_world(scenario);
  const RayScene rays(world);
  SessionOptions options;
  options.progress = [](double share) { return share < 0.3; };
  RecordingEstimator estimator;
  const RunRecord record = run_session(scenario, world, rays, options, estimator);
  EXPECT_EQ(record.fault, "interrupted");
  EXPECT_FALSE(record.ground_truth.empty());
}

TEST_F(Session, RefusesAWorldAndAMotionThatCannotBe) {
  const Scenario standing = load({"motion.waypoints=[[0, 0, 1], [0, 0, 1]]"});
  EXPECT_THAT([&] { body_trajectory(standing); }, ::testing::ThrowsMessage<InputError>(HasSubstr("waypoints")));
  const Scenario broken = load();
  files_.write("room.xml", "<mujoco><worldbody><geom type='cube'/></worldbody></mujoco>");
  EXPECT_THAT([&] { make_world(broken); }, ::testing::ThrowsMessage<InputError>(HasSubstr("room.xml")));
}

TEST(CalibrationOfARig, HoldsTheMountingAndTheDataSheetOnly) {
  RigConfig rig;
  rig.decimation = 2;
  rig.lidar = vlp16();
  rig.pack_from_lidar.translation = {0.0, 0.0, 0.1};
  const Calibration calibration = calibration_of(rig);
  EXPECT_EQ(calibration.imu_rate_hz, 100.0);
  EXPECT_EQ(calibration.lidar_rings, 16);
  EXPECT_EQ(calibration.body_from_lidar.translation.z(), 0.1);
  EXPECT_NEAR(calibration.camera_noise.read_noise_dn, 29.0 / 85.0, 1e-12);
  EXPECT_EQ(calibration.camera.width, 640);
}

/// A person who carries a scanner that turns all about has its back full of returns from trunk, head and arms.
TEST_F(Session, TheCalibrationKnowsWhatOfTheVehicleIsInView) {
  const Scenario scenario = load({"motion.vehicle=walker", "rig.lidar.model=utm30lx_spinning", "rig.pitch_deg=20",
                                  "rig.lidar.effects.mixed_pixels=false"});
  const OwnBodyMask mask(calibration_of(scenario));
  const World world = make_world(scenario);
  const RayScene rays(world);
  struct NearReturns : RecordingEstimator {
    void add(const LidarScan& scan) override {
      for (const LidarPoint& point : scan.points) {
        if (point.position.norm() < 0.7F) (mask.covers(point.position) ? covered : open)++;
      }
    }
    using RecordingEstimator::add;
    explicit NearReturns(const OwnBodyMask& of) : mask(of) {}
    const OwnBodyMask& mask;
    int covered = 0;
    int open = 0;
  } near(mask);
  run_session(scenario, world, rays, {}, near);
  EXPECT_GT(near.covered, 1'000);
  EXPECT_EQ(near.open, 0) << "the room's walls are metres away";

  EXPECT_TRUE(calibration_of(load({"motion.vehicle=walker", "rig.own_body=false"})).own_body.empty());
  EXPECT_TRUE(calibration_of(load()).own_body.empty());
}

}  // namespace
}  // namespace plumbline
