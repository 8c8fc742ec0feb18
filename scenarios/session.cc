#include "scenarios/session.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "scenarios/calibration.h"
#include "scenarios/map_colouring.h"
#include "scenarios/recorder.h"
#include "scenarios/sensor_stream.h"
#include "sim/glare.h"
#include "sim/rig_driver.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {
namespace {

constexpr const char* kInterrupted = "interrupted";
constexpr double kReportedShare = 0.005;  // progress between two reports

/// Calls something whose complaints about its arguments are complaints about the scenario.
template <typename Call>
auto as_input(const Scenario& scenario, Call call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw InputError(scenario.path.string() + ": " + error.what());
  }
}

/// The true poses of the IMU, which is the estimator's body, at every time that it measures.
class TruthLog {
 public:
  TruthLog(const Scenario& scenario, const Trajectory& world_from_body, const SessionOptions& options,
           const SessionListener& listener)
      : world_from_body_(world_from_body),
        body_from_imu_(Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body),
        period_ns_(std::llround(1e9 / scenario.rig.imu.rate_hz)),
        count_(world_from_body.end_ns() / period_ns_),
        options_(options),
        listener_(listener) {}

  /// Goes on to a time, included. @return false if the run is to end
  bool up_to(std::int64_t stamp_ns) {
    const std::int64_t samples_per_report = std::max<std::int64_t>(count_ / 200, 1);
    while (logged_ < count_ && (logged_ + 1) * period_ns_ <= stamp_ns) {
      const std::int64_t next_ns = ++logged_ * period_ns_;
      listener_.truth(next_ns, world_from_body_.pose(next_ns) * body_from_imu_);
      if (options_.progress && logged_ % samples_per_report == 0 &&
          !options_.progress(static_cast<double>(logged_) / static_cast<double>(count_))) {
        return false;
      }
    }
    return true;
  }

 private:
  const Trajectory& world_from_body_;
  const Pose body_from_imu_;
  const std::int64_t period_ns_;
  const std::int64_t count_;
  const SessionOptions& options_;
  const SessionListener& listener_;
  std::int64_t logged_ = 0;
};

/// Glare comes last: it is as strong at every level of light.
void set_conditions(World& world, const WorldConfig& config) {
  if (config.sun_lux) world.set_sun(*config.sun_lux);
  if (config.night) world.make_night();
  const bool lamplight = world.sun().lux == 0.0 && !config.night;
  if (config.light_lux || lamplight) world.set_light_level(config.light_lux.value_or(config.usual_lux));
  world.scale_contrast(config.contrast);
  world.atmosphere = config.atmosphere;
  world.rig_lamp_cd = config.rig_lamp_cd;
  if (config.glare_patches == 0) return;
  for (const Lamp& lamp : glare_lamps(world, RayScene(world), config.glare_patches)) world.add_lamp(lamp);
}

bool run(const Scenario& scenario, const Trajectory& world_from_body, const MessageSource& source,
         const SessionOptions& options, const SessionListener& listener) {
  TruthLog truth(scenario, world_from_body, options, listener);
  while (const auto message = source()) {
    if (!truth.up_to(message->delivery_ns)) return false;
    if (!listener.message(*message)) return true;
  }
  return truth.up_to(world_from_body.end_ns());
}

bool run(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
         const SessionOptions& options, const SessionListener& listener) {
  const MessageSource source = options.threads > 1 ? make_read_ahead_source(scenario, surroundings, world_from_body)
                                                   : make_source(scenario, surroundings, world_from_body);
  return run(scenario, world_from_body, source, options, listener);
}

}  // namespace

World make_world(const Scenario& scenario) {
  return as_input(scenario, [&] {
    const WorldConfig& config = scenario.world;
    const std::uint64_t seed = config.seed.value_or(scenario.seed);
    World world = config.scene.empty() ? World::from_mjcf_file(config.mjcf, seed)
                                       : World::from_scene(build_scene(config.scene, config.parameters, seed), seed);
    set_conditions(world, config);
    return world;
  });
}

Trajectory make_body_trajectory(const Scenario& scenario, const World& world, const RayScene& rays) {
  return as_input(scenario, [&] {
    return mounted_on(make_trajectory(scenario.motion, world, rays, scenario.seed), scenario.rig.vehicle_from_pack);
  });
}

std::unique_ptr<OwnBody> make_own_body(const Scenario& scenario) {
  if (!scenario.rig.own_body || scenario.motion.vehicle.empty()) return nullptr;
  const VehicleInfo& vehicle = vehicle_named(scenario.motion.vehicle);
  if (vehicle.body == nullptr) return nullptr;
  World world = World::from_scene(vehicle.body(), scenario.seed);
  RayScene rays(world);
  return std::make_unique<OwnBody>(
      OwnBody{std::move(world), std::move(rays), scenario.rig.vehicle_from_pack.inverse()});
}

RunRecord run_session(const Scenario& scenario, const World& world, const RayScene& rays,
                      const SessionOptions& options) {
  const auto estimator = as_input(scenario, [&] {
    return make_estimator(scenario.estimator_name, calibration_of(scenario.rig), scenario.estimator);
  });
  return run_session(scenario, world, rays, options, *estimator);
}

RunRecord run_session(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
                      Estimator& estimator) {
  const Trajectory world_from_body = make_body_trajectory(scenario, world, rays);
  Recorder recorder(estimator, 0, world_from_body.end_ns(), options.on_image);
  const std::unique_ptr<OwnBody> own_body = make_own_body(scenario);
  const Surroundings surroundings{world, rays, own_body.get()};
  const bool whole = run(scenario, surroundings, world_from_body, options,
                         {[&](std::int64_t stamp_ns, const Pose& pose) { recorder.add_truth(stamp_ns, pose); },
                          [&](const SensorMessage& message) {
                            recorder.deliver(message);
                            return !recorder.faulted();
                          }});
  if (!whole) recorder.set_fault(kInterrupted);
  RunRecord record = recorder.finish();
  colour_map(scenario, surroundings, world_from_body, record);
  return record;
}

bool simulate(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
              const SessionListener& listener) {
  const Trajectory world_from_body = make_body_trajectory(scenario, world, rays);
  const std::unique_ptr<OwnBody> own_body = make_own_body(scenario);
  return run(scenario, Surroundings{world, rays, own_body.get()}, world_from_body, options, listener);
}

RunRecord run_recording(const Recording& recording, const SessionOptions& options, Estimator& estimator) {
  Recorder recorder(estimator, recording.start_ns, recording.end_ns);
  const double span_ns = std::max(1.0, static_cast<double>(recording.end_ns - recording.start_ns));
  std::optional<std::int64_t> first_ns;
  std::int64_t last_ns = 0;
  double reported = 0.0;
  while (!recorder.faulted()) {
    const auto message = recording.messages();
    if (!message) break;
    recorder.deliver(*message);
    last_ns = first_ns ? std::max(last_ns, message->delivery_ns) : message->delivery_ns;
    if (!first_ns) first_ns = message->delivery_ns;
    const double share = std::clamp(static_cast<double>(last_ns - recording.start_ns) / span_ns, 0.0, 1.0);
    if (!options.progress || share < reported + kReportedShare) continue;
    reported = share;
    if (!options.progress(share)) recorder.set_fault(kInterrupted);
  }
  for (const auto& [stamp_ns, pose] : recording.truth) {
    if (first_ns && *first_ns <= stamp_ns && stamp_ns <= last_ns) recorder.add_truth(stamp_ns, pose);
  }
  return recorder.finish();
}

}  // namespace plumbline
