#include "scenarios/session.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scenarios/as_input.h"
#include "scenarios/calibration.h"
#include "scenarios/flight_session.h"
#include "scenarios/map_colouring.h"
#include "scenarios/recorder.h"
#include "scenarios/sensor_stream.h"
#include "scenarios/truth_log.h"
#include "sim/glare.h"
#include "sim/rig_driver.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {
namespace {

constexpr double kReportedShare = 0.005;  // progress between two reports

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
  TruthLog truth(scenario.rig.imu, world_from_body, world_from_body.end_ns(), options, listener.truth);
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
  if (scenario.motion.closed_loop.enabled) {
    throw InputError(scenario.path.string() +
                     ": motion.closed_loop.enabled: found true, expected false: what an estimator has not flown yet is "
                     "not known");
  }
  return as_input(scenario, [&] {
    return mounted_on(make_trajectory(scenario.motion, world, rays, scenario.seed), scenario.rig.vehicle_from_pack);
  });
}

Pose world_from_imu_at_start(const Scenario& scenario, const World& world, const RayScene& rays) {
  const Pose world_from_body = scenario.motion.closed_loop.enabled
                                   ? world_from_body_on_pad(scenario, world)
                                   : make_body_trajectory(scenario, world, rays).pose(0);
  return world_from_body * Pose{Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body};
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
  const auto estimator = as_input(
      scenario, [&] { return make_estimator(scenario.estimator_name, calibration_of(scenario), scenario.estimator); });
  return run_session(scenario, world, rays, options, *estimator);
}

RunRecord run_session(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
                      Estimator& estimator) {
  if (scenario.motion.closed_loop.enabled) return run_flight(scenario, world, rays, options, estimator);
  return std::move(run_session(scenario, world, rays, options, std::vector<Estimator*>{&estimator}).front());
}

std::vector<RunRecord> run_session(const Scenario& scenario, const World& world, const RayScene& rays,
                                   const SessionOptions& options, const std::vector<Estimator*>& estimators) {
  const Trajectory world_from_body = make_body_trajectory(scenario, world, rays);
  std::vector<Recorder> recorders;
  for (Estimator* estimator : estimators) {
    recorders.emplace_back(*estimator, 0, world_from_body.end_ns(), options.on_image);
  }
  const std::unique_ptr<OwnBody> own_body = make_own_body(scenario);
  const Surroundings surroundings{world, rays, own_body.get()};
  const bool whole = run(scenario, surroundings, world_from_body, options,
                         {[&](std::int64_t stamp_ns, const Pose& pose) {
                            for (Recorder& recorder : recorders) recorder.add_truth(stamp_ns, pose);
                          },
                          [&](const SensorMessage& message) {
                            bool goes_on = false;
                            for (Recorder& recorder : recorders) {
                              if (!recorder.faulted()) recorder.deliver(message);
                              goes_on |= !recorder.faulted();
                            }
                            return goes_on;
                          }});
  std::vector<RunRecord> records;
  for (Recorder& recorder : recorders) {
    if (!whole) recorder.set_fault(kInterrupted);
    records.push_back(recorder.finish());
    colour_map(scenario, surroundings, world_from_body, records.back());
  }
  return records;
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
