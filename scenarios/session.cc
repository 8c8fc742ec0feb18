#include "scenarios/session.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "scenarios/calibration.h"
#include "scenarios/recorder.h"
#include "scenarios/sensor_stream.h"
#include "sim/rig_driver.h"
#include "sim/surroundings.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {
namespace {

/// Calls something whose complaints about its arguments are complaints about the scenario.
template <typename Call>
auto as_input(const Scenario& scenario, Call call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw InputError(scenario.path.string() + ": " + error.what());
  }
}

/// Delivers what is due before a time.
class Delivery {
 public:
  Delivery(MessageSource source, Recorder& recorder) : source_(std::move(source)), recorder_(recorder) { advance(); }

  void up_to(std::int64_t end_ns) {
    while (next_ && next_->delivery_ns < end_ns && !recorder_.faulted()) {
      std::visit([&](const auto& message) { recorder_.deliver(message); }, next_->payload);
      advance();
    }
  }

 private:
  void advance() {
    next_ = source_();
    if (next_) recorder_.add_sensors_wall(next_->wall_s);
  }

  MessageSource source_;
  Recorder& recorder_;
  std::unique_ptr<SensorMessage> next_;
};

void run(const Scenario& scenario, const Trajectory& world_from_body, MessageSource source,
         const SessionOptions& options, Recorder& recorder) {
  Imu imu(scenario.rig.imu, scenario.seed);
  imu.noise_enabled = scenario.rig.imu_noise;
  Delivery others(std::move(source), recorder);
  const std::int64_t period_ns = imu.period_ns();
  const std::int64_t samples = world_from_body.end_ns() / period_ns;
  const std::int64_t samples_per_report = std::max<std::int64_t>(samples / 200, 1);
  for (std::int64_t k = 1; k <= samples && !recorder.faulted(); ++k) {
    const std::int64_t stamp_ns = k * period_ns;
    others.up_to(stamp_ns);
    recorder.add_truth(stamp_ns, world_from_body.pose(stamp_ns));
    const ImuSample sample = imu.sample(world_from_body, stamp_ns);
    if (k % scenario.rig.decimation == 0) recorder.deliver(sample);
    if (options.progress && k % samples_per_report == 0) {
      const bool go_on = options.progress(static_cast<double>(k) / static_cast<double>(samples));
      if (!go_on) return recorder.set_fault("interrupted");
    }
  }
  others.up_to(world_from_body.end_ns() + 1);
}

/// The vehicle as its sensors see it, or nothing.
std::unique_ptr<OwnBody> own_body_of(const Scenario& scenario) {
  if (!scenario.rig.own_body || scenario.motion.vehicle.empty()) return nullptr;
  const VehicleInfo& vehicle = vehicle_named(scenario.motion.vehicle);
  if (vehicle.body == nullptr) return nullptr;
  World world = World::from_scene(vehicle.body(), scenario.seed);
  RayScene rays(world);
  return std::make_unique<OwnBody>(
      OwnBody{std::move(world), std::move(rays), scenario.rig.vehicle_from_pack.inverse()});
}

}  // namespace

World make_world(const Scenario& scenario) {
  return as_input(scenario, [&] {
    const WorldConfig& config = scenario.world;
    const std::uint64_t seed = config.seed.value_or(scenario.seed);
    World world = config.scene.empty() ? World::from_mjcf_file(config.mjcf, seed)
                                       : World::from_scene(build_scene(config.scene, config.parameters, seed), seed);
    world.set_light_level(config.light_lux);
    return world;
  });
}

Trajectory make_body_trajectory(const Scenario& scenario, const World& world, const RayScene& rays) {
  return as_input(scenario, [&] {
    return mounted_on(make_trajectory(scenario.motion, world, rays, scenario.seed), scenario.rig.vehicle_from_pack);
  });
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
  Recorder recorder(estimator, world_from_body.end_ns());
  const std::unique_ptr<OwnBody> own_body = own_body_of(scenario);
  const Surroundings surroundings{world, rays, own_body.get()};
  MessageSource source = options.threads > 1 ? make_read_ahead_source(scenario, surroundings, world_from_body)
                                             : make_source(scenario, surroundings, world_from_body);
  run(scenario, world_from_body, std::move(source), options, recorder);
  return recorder.finish();
}

}  // namespace plumbline
