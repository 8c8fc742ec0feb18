#include "scenarios/flight_session.h"

#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "scenarios/as_input.h"
#include "scenarios/flight_guidance.h"
#include "scenarios/live_sensors.h"
#include "scenarios/map_colouring.h"
#include "scenarios/recorder.h"
#include "scenarios/truth_log.h"
#include "sim/path.h"
#include "sim/vehicles/guided_flight.h"

namespace plumbline {
namespace {

constexpr std::int64_t kStep_ns = 1'000'000;
static_assert(RotorCraft::kStep_s == 1e-9 * static_cast<double>(kStep_ns));
// Between the control poses of the true motion: a spline of them rounds off nothing that rotors can do.
constexpr std::int64_t kControl_ns = 2'000'000;
// What lies two control poses back no longer changes, and the rig's own steps do not read beyond it.
constexpr std::int64_t kUnknown_ns = 2 * kControl_ns;
constexpr std::int64_t kSample_ns = 10'000'000;
constexpr int kRendererThreads = 2;

class Flight {
 public:
  Flight(const Scenario& scenario, const Surroundings& surroundings, const SessionOptions& options,
         Estimator& estimator, GuidedFlight& craft)
      : scenario_(scenario),
        surroundings_(surroundings),
        craft_(craft),
        end_ns_(std::llround(craft.duration_s() * 1e9)),
        world_from_body_(craft.world_from_craft() * scenario.rig.vehicle_from_pack, 0, kControl_ns),
        imu_in_body_(Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body),
        recorder_(estimator, 0, end_ns_, options.on_image),
        log_truth_([this](std::int64_t stamp_ns, const Pose& pose) { recorder_.add_truth(stamp_ns, pose); }),
        truth_(scenario.rig.imu, world_from_body_, end_ns_, options, log_truth_),
        sensors_(scenario, surroundings, world_from_body_, options.threads > 1 ? kRendererThreads : 0),
        guidance_(scenario, world_from_body_.pose(0) * imu_in_body_, options.world_from_estimate) {}

  RunRecord fly() {
    while (now_ns_ < end_ns_ && record_.end == FlightEnd::kCut && !recorder_.faulted()) step();
    if (now_ns_ >= end_ns_ && record_.end == FlightEnd::kCut) record_.end = FlightEnd::kFlown;
    RunRecord record = recorder_.finish();
    record.flight = std::move(record_);
    colour_map(scenario_, surroundings_, world_from_body_, record);
    return record;
  }

  void set_waypoints(std::vector<Eigen::Vector3d> waypoints) { record_.waypoints = std::move(waypoints); }

 private:
  void step() {
    if (craft_.on_pad() && craft_.time_s() >= craft_.release_s()) guidance_.lay_out(now_ns_);
    const std::optional<FlightState> believed = guidance_.believed(now_ns_);
    if (!craft_.on_pad() && now_ns_ % kSample_ns == 0) sample();
    craft_.step(believed);
    now_ns_ += kStep_ns;
    if (now_ns_ % kControl_ns != 0) return;
    world_from_body_.extend(craft_.world_from_craft() * scenario_.rig.vehicle_from_pack);
    measure_up_to(now_ns_ - kUnknown_ns);
  }

  void measure_up_to(std::int64_t known_ns) {
    if (!truth_.up_to(known_ns)) return recorder_.set_fault(kInterrupted);
    sensors_.measure(known_ns);
    while (const auto message = sensors_.next(known_ns)) {
      const std::size_t before = recorder_.odometry().size();
      recorder_.deliver(*message);
      const auto* sample = std::get_if<ImuSample>(&message->payload);
      if (sample == nullptr || !message->lost.empty()) continue;
      for (std::size_t i = before; i < recorder_.odometry().size(); ++i) {
        guidance_.add(recorder_.odometry()[i], *sample, message->delivery_ns);
      }
    }
  }

  /// Where the craft is against where it should be, what it knows, and what is near.
  void sample() {
    FlightSample sample;
    sample.stamp_ns = now_ns_;
    sample.wanted = craft_.wanted().position;
    sample.flown = craft_.state().position;
    if (const auto known = guidance_.newest()) {
      const Pose truth = world_from_body_.pose(known->stamp_ns) * imu_in_body_;
      sample.estimate_error = known->world_from_body.translation - truth.translation;
    }
    const double limit_m = kMostClearance_m + GuidedFlight::kReach_m;
    sample.clearance_m = surroundings_.rays.distance_to_surface(sample.flown, limit_m) - GuidedFlight::kReach_m;
    record_.samples.push_back(sample);
    if (sample.clearance_m <= 0.0) {
      record_.end = FlightEnd::kStruck;
    } else if ((sample.flown - sample.wanted).norm() > kAstray_m) {
      record_.end = FlightEnd::kAstray;
    }
  }

  const Scenario& scenario_;
  const Surroundings surroundings_;
  GuidedFlight& craft_;
  const std::int64_t end_ns_;
  std::int64_t now_ns_ = 0;
  Trajectory world_from_body_;
  const Pose imu_in_body_;
  Recorder recorder_;
  const TruthLog::Listener log_truth_;
  TruthLog truth_;
  LiveSensors sensors_;
  FlightGuidance guidance_;
  FlightRecord record_;
};

std::vector<Eigen::Vector3d> waypoints_of(const MotionConfig& config, const World& world) {
  std::vector<Eigen::Vector3d> points = points_of(config, world);
  const double above_m = config.route.empty() ? 0.0 : config.height_m;
  for (Eigen::Vector3d& point : points) point.z() += above_m;
  return points;
}

GuidedFlight craft_of(const Scenario& scenario, const World& world) {
  return as_input(scenario, [&] { return GuidedFlight(scenario.motion, world, scenario.seed); });
}

}  // namespace

Pose world_from_body_on_pad(const Scenario& scenario, const World& world) {
  return craft_of(scenario, world).world_from_craft() * scenario.rig.vehicle_from_pack;
}

RunRecord run_flight(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
                     Estimator& estimator) {
  const std::unique_ptr<OwnBody> own_body = make_own_body(scenario);
  const Surroundings surroundings{world, rays, own_body.get()};
  GuidedFlight craft = craft_of(scenario, world);
  Flight flight(scenario, surroundings, options, estimator, craft);
  flight.set_waypoints(as_input(scenario, [&] { return waypoints_of(scenario.motion, world); }));
  return flight.fly();
}

}  // namespace plumbline
