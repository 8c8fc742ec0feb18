#include <cmath>
#include <stdexcept>

#include "sim/band_limiter.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"
#include "sim/vehicles/flying.h"
#include "sim/vehicles/rotor_craft.h"
#include "sim/vehicles/wind.h"

namespace plumbline {
namespace {

static_assert(RotorCraft::kStep_s == BandLimiter::kStep_s);

Trajectory fly(const MotionConfig& config, const World& world, const RayScene& /*rays*/, std::uint64_t seed) {
  constexpr double kOff_m = 2.0;
  constexpr double kHover_s = 1.5;  // before time 0 and after the end
  const FlightReference reference(config, world);
  const RotorCraftDesign design;
  const FlightState start = reference.at(0.0);
  RotorCraft craft(design, {start.attitude, start.position});
  Wind wind(config.wind_mps, seed);
  BandLimiter motion(-BandLimiter::kLead_ns);
  constexpr std::int64_t kLead = BandLimiter::kLead_ns / BandLimiter::kStep_ns;
  const auto hover = static_cast<std::int64_t>(kHover_s / RotorCraft::kStep_s);
  const auto steps = static_cast<std::int64_t>(reference.duration_s() / RotorCraft::kStep_s) + hover;
  for (std::int64_t i = -hover; i <= steps; ++i) {
    const double time_s = static_cast<double>(i) * RotorCraft::kStep_s;
    const FlightState now = craft.state();
    const FlightState wanted = reference.at(time_s);
    if ((now.position - wanted.position).norm() > kOff_m) {
      throw std::invalid_argument("motion: the quadrotor cannot follow its path after " + std::to_string(time_s) +
                                  " s; lower speed_mps, acceleration_mps2, lateral_acceleration_mps2 or wind_mps");
    }
    if (i >= -kLead) motion.add({now.attitude, now.position});
    craft.step(track(design, now, wanted), wind.next());
  }
  return motion.finish();
}

/// Arms, motors and rotor discs about the plate that carries the pack.
SceneDescription quadrotor_body() {
  MjcfWriter writer;
  const double offset_m = RotorCraftDesign{}.arm_m * std::sqrt(0.5);
  writer.box("car_black", {-0.08, -0.06, -0.06}, {0.08, 0.06, -0.03});
  for (const double x : {-offset_m, offset_m}) {
    for (const double y : {-offset_m, offset_m}) {
      writer.cylinder("car_black", {0.0, 0.0, -0.045}, {x, y, -0.045}, 0.01);
      writer.cylinder("steel", {x, y, -0.05}, {x, y, -0.015}, 0.015);
    }
  }
  return writer.finish("quadrotor", scene_palette(), 30.0, 0.0);
}

}  // namespace

Trajectory quadrotor_reference(const MotionConfig& config, const World& world) {
  return FlightReference(config, world).trajectory();
}

VehicleInfo quadrotor_vehicle() {
  MotionConfig defaults;
  defaults.vehicle = "quadrotor";
  defaults.speed_mps = 4.0;
  defaults.acceleration_mps2 = 3.0;
  defaults.lateral_acceleration_mps2 = 5.0;
  defaults.smoothing_s = 0.8;
  defaults.height_m = 2.5;
  return {.name = "quadrotor",
          .summary = "quadrotor, simulated: four rotors with lag and limits, geometric controller, wind",
          .defaults = defaults,
          .drive = fly,
          .body = quadrotor_body};
}

}  // namespace plumbline
