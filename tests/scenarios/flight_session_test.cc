#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "scenarios/calibration.h"
#include "scenarios/session.h"
#include "tests/scenarios/room.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Every way-point's corner is blunt enough for the reference to pass it within centimetres.
constexpr char kMission[] = R"(
world: {mjcf: room.xml}
motion:
  vehicle: quadrotor
  rest_s: 1
  speed_mps: 2
  wind_mps: 2
  waypoints: [[-4, -2, 1.2], [-2, -2, 1.6], [0, -1.5, 2], [2, 0, 2]]
  closed_loop: {enabled: true, latency_ms: 10}
rig:
  pitch_deg: 20
  z_m: 0.05
  camera: {width: 96, height: 64}
  imu: {noise: false, x_m: 0.03}
estimator: {name: imu}
)";

/// Another estimator's outputs, spoilt.
class SpoiltEstimator : public Estimator {
 public:
  using Spoil = std::function<void(Odometry&)>;
  SpoiltEstimator(std::unique_ptr<Estimator> good, Spoil spoil) : good_(std::move(good)), spoil_(std::move(spoil)) {}

  void add(const ImuSample& sample) override { good_->add(sample); }
  void add(const CameraFrame& frame) override { good_->add(frame); }
  void add(const DepthFrame& frame) override { good_->add(frame); }
  void add(const LidarScan& scan) override { good_->add(scan); }
  std::vector<Odometry> take() override {
    std::vector<Odometry> outputs = good_->take();
    for (Odometry& output : outputs) spoil_(output);
    return outputs;
  }
  MessageCounts counts(Module module) const override { return good_->counts(module); }

 private:
  std::unique_ptr<Estimator> good_;
  Spoil spoil_;
};

class FlightSession : public ::testing::Test {
 protected:
  Scenario load(const std::vector<std::string>& overrides = {}) const {
    files_.write("room.xml", kRoom);
    return load_scenario(files_.write("mission.yaml", kMission), overrides, {});
  }

  static RunRecord fly(const Scenario& scenario, int threads = 2, const SpoiltEstimator::Spoil& spoil = {},
                       const std::optional<Pose>& world_from_estimate = std::nullopt) {
    const World world = make_world(scenario);
    const RayScene rays(world);
    SessionOptions options;
    options.threads = threads;
    options.world_from_estimate = world_from_estimate;
    if (!spoil) return run_session(scenario, world, rays, options);
    SpoiltEstimator estimator(make_estimator(scenario.estimator_name, calibration_of(scenario), scenario.estimator),
                              spoil);
    return run_session(scenario, world, rays, options, estimator);
  }

  TemporaryDirectory files_;
};

double worst(const FlightRecord& flight, const std::function<double(const FlightSample&)>& error) {
  double worst = 0.0;
  for (const FlightSample& sample : flight.samples) worst = std::max(worst, error(sample));
  return worst;
}

double tracking_m(const FlightSample& sample) { return (sample.flown - sample.wanted).norm(); }

// Dead reckoning on an ideal IMU is all but the truth over some seconds, whatever the pack's tilt and place.
TEST_F(FlightSession, FliesItsMissionOnWhatTheEstimatorSays) {
  const RunRecord record = fly(load());
  ASSERT_TRUE(record.flight);
  EXPECT_EQ(record.flight->end, FlightEnd::kFlown);
  EXPECT_EQ(record.flight->waypoints.size(), 4U);
  // An IMU's means leave out what turns between two samples: a few millimetres.
  EXPECT_LT(worst(*record.flight, [](const FlightSample& s) { return s.estimate_error.norm(); }), 0.03);
  // Wind of 2 m/s and its gusts push by 0.9 N at most, which the controller meets 5 cm off; the rest is the latency's.
  EXPECT_LT(worst(*record.flight, tracking_m), 0.1);
  // It ends where the mission does.
  EXPECT_LT((record.flight->samples.back().flown - record.flight->waypoints.back()).norm(), 0.1);
}

TEST_F(FlightSession, StandsOnItsPadUntilTheMissionBegins) {
  const RunRecord record = fly(load());
  ASSERT_FALSE(record.ground_truth.empty());
  const Eigen::Vector3d first = record.ground_truth.front().pose.translation;
  for (const auto& [stamp_ns, pose] : record.ground_truth) {
    if (stamp_ns >= 980'000'000) break;
    EXPECT_LT((pose.translation - first).norm(), 1e-12) << stamp_ns;
  }
  EXPECT_GE(record.flight->samples.front().stamp_ns, 1'000'000'000);
}

TEST_F(FlightSession, TheTruthThatSensorsMeasureIsWhatTheCraftFlew) {
  const Scenario scenario = load();
  const RunRecord record = fly(scenario);
  const Pose craft_from_imu =
      scenario.rig.vehicle_from_pack * Pose{Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body};
  std::size_t compared = 0;
  for (const FlightSample& sample : record.flight->samples) {
    for (const auto& [stamp_ns, pose] : record.ground_truth) {
      if (stamp_ns != sample.stamp_ns) continue;
      ++compared;
      // Control poses 2 ms apart round off a thousandth of a g^-1 of the acceleration: micrometres.
      EXPECT_LT(((pose * craft_from_imu.inverse()).translation - sample.flown).norm(), 1e-4);
    }
  }
  EXPECT_GT(compared, 100U);
}

TEST_F(FlightSession, SameBytesForAnyNumberOfThreads) {
  const Scenario scenario =
      load({"estimator.name=vloam", "rig.imu.noise=true", "motion.waypoints=[[-4, -2, 1.2], [-3, -2, 1.4]]"});
  const RunRecord one = fly(scenario, 1);
  const RunRecord three = fly(scenario, 3);
  ASSERT_EQ(one.ground_truth.size(), three.ground_truth.size());
  ASSERT_EQ(one.estimate.size(), three.estimate.size());
  for (std::size_t i = 0; i < one.ground_truth.size(); ++i) {
    ASSERT_EQ(one.ground_truth[i].pose.translation, three.ground_truth[i].pose.translation) << i;
    ASSERT_EQ(one.ground_truth[i].pose.rotation.coeffs(), three.ground_truth[i].pose.rotation.coeffs()) << i;
  }
  for (std::size_t i = 0; i < one.estimate.size(); ++i) {
    ASSERT_EQ(one.estimate[i].pose.translation, three.estimate[i].pose.translation) << i;
  }
  ASSERT_EQ(one.flight->samples.size(), three.flight->samples.size());
}

// A scan that took 60 ms to arrive at 2 m/s, matched as if it showed where the craft is by then, would pull the
// estimate back by 0.12 m ten times a second.
TEST_F(FlightSession, ScansThatComeLateDoNotHoldTheEstimateBack) {
  const RunRecord record = fly(load({"estimator.name=vloam", "rig.imu.noise=true", "rig.lidar.delay_ms=60"}));
  EXPECT_EQ(record.flight->end, FlightEnd::kFlown);
  // Matching errs by centimetres in a bare room.
  EXPECT_LT(worst(*record.flight, [](const FlightSample& s) { return s.estimate_error.norm(); }), 0.1);
}

// The attitude's loop crosses over at 31 rad/s: a delay of 0.15 s turns its phase by three quarters of a turn.
TEST_F(FlightSession, FallsWithALatencyBeyondItsControllersBandwidth) {
  const RunRecord record = fly(load({"motion.closed_loop.latency_ms=150"}));
  EXPECT_NE(record.flight->end, FlightEnd::kFlown);
  EXPECT_LT(worst(*record.flight, [](const FlightSample& s) { return s.estimate_error.norm(); }), 0.5);
}

TEST_F(FlightSession, GoesWhereAWrongEstimateLeadsIt) {
  const RunRecord record = fly(load(), 2, [](Odometry& output) {
    const double since_s = static_cast<double>(output.stamp_ns) * 1e-9 - 2.0;
    if (since_s > 0.0) output.world_from_body.translation.y() += 0.5 * since_s;
  });
  // Believed 1 m further left than it is after 2 s, it flies 1 m further right.
  const auto& samples = record.flight->samples;
  const FlightSample& last = samples.back();
  EXPECT_GT(last.estimate_error.y(), 0.5);
  // What is left without the estimate's error is the control's: 0.5 m/s of drift that its velocity does not show, by
  // the ratio of the controller's gains, 6 / 12 s, and the wind's 5 cm.
  EXPECT_LT((last.flown - last.wanted + last.estimate_error).norm(), 0.25 + 0.1);
}

// The estimate's world laid 0.4 m further left than it lies, as a map may be: what is flown is the mission on the map.
TEST_F(FlightSession, OnAMapItsMissionIsWhereTheMapLies) {
  const Scenario scenario = load();
  const World world = make_world(scenario);
  // Dead reckoning's world begins level, at the start and facing as the craft does.
  const Pose start = world_from_imu_at_start(scenario, world, RayScene(world));
  const Eigen::Vector3d yaw{0.0, 0.0, rpy_from_rotation(start.rotation).z()};
  const Pose map_from_own{rotation_from_rpy(yaw), start.translation};
  const auto on_map = [&map_from_own](Odometry& output) {
    output.world_from_body = map_from_own * output.world_from_body;
    output.velocity_in_world = map_from_own.rotation * output.velocity_in_world;
  };
  const Pose world_from_map{Eigen::Quaterniond::Identity(), {0.0, 0.4, 0.0}};
  const RunRecord record = fly(scenario, 2, on_map, world_from_map);
  ASSERT_FALSE(record.flight->samples.empty());
  const FlightSample& last = record.flight->samples.back();
  EXPECT_NEAR(last.estimate_error.y(), 0.4, 0.05);
  EXPECT_NEAR((last.flown - last.wanted).y(), -0.4, 0.1);
}

TEST_F(FlightSession, AnEstimateThatIsNoNumberIsNotFlownOn) {
  const RunRecord record = fly(load(), 2, [](Odometry& output) {
    if (output.stamp_ns % 50'000'000 == 0) output.world_from_body.translation.x() = std::nan("");
  });
  EXPECT_EQ(record.flight->end, FlightEnd::kFlown);
  EXPECT_LT(worst(*record.flight, tracking_m), 0.15);
}

TEST_F(FlightSession, EndsWhereItStrikesSomething) {
  // The last way-point lies inside a wall.
  const RunRecord record = fly(load({"motion.waypoints=[[4, 0, 1.2], [8, 0, 2]]"}));
  EXPECT_EQ(record.flight->end, FlightEnd::kStruck);
  EXPECT_LE(record.flight->samples.back().clearance_m, 0.0);
  // The wall's face is at 7.9 m and the craft reaches 0.32 m; it came 15 mm in a sample of 10 ms at most.
  EXPECT_NEAR(record.flight->samples.back().flown.x(), 7.58, 0.05);
}

TEST_F(FlightSession, IsNotKnownAhead) {
  const Scenario scenario = load();
  const World world = make_world(scenario);
  EXPECT_THAT([&] { make_body_trajectory(scenario, world, RayScene(world)); },
              ThrowsMessage<InputError>(HasSubstr("motion.closed_loop.enabled")));
}

TEST_F(FlightSession, KeysAreCheckedWithTheirNames) {
  const auto refused = [&](const std::vector<std::string>& overrides, const std::string& why) {
    EXPECT_THAT([&] { load(overrides); }, ThrowsMessage<InputError>(HasSubstr(why))) << overrides.front();
  };
  refused({"motion.closed_loop.latency_ms=0"}, "motion.closed_loop.latency_ms");
  refused({"motion.closed_loop.latency_ms=.nan"}, "motion.closed_loop.latency_ms");
  refused({"motion.closed_loop.delay=3"}, "motion.closed_loop.delay");
  refused({"motion.closed_loop=true"}, "motion.closed_loop");
  refused({"motion.vehicle=walker"}, "quadrotor");
  refused({"motion.route_speeds=[{from_m: 1, speed_mps: 2}]"}, "motion.route_speeds");
  refused({"motion.route_speeds=[{from_m: 1}]"}, "motion.route_speeds[0]");
}

}  // namespace
}  // namespace plumbline
