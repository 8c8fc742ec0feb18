#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"
#include "sim/vehicles/ground_vehicles.h"

namespace plumbline {
namespace {

// A two-seated off-road utility vehicle: light, short, on soft springs with long travel.
WheeledDesign utility() {
  WheeledDesign design;
  design.name = "utility";
  design.mass_kg = 620.0;
  design.inertia = {190.0, 420.0, 480.0};
  design.centre_of_mass = {0.95, 0.0, 0.28};
  design.pack_in_chassis = {1.0, 0.0, 1.48};  // on the roll cage, 1.8 m above the ground
  design.wheelbase_m = 1.95;
  design.track_m = 1.25;
  design.tyre.radius_m = 0.32;
  design.tyre.stiffness = 90e3;
  design.tyre.damping = 600.0;
  design.tyre.slip_stiffness = 9.0;
  design.tyre.friction = 0.8;
  design.tyre.rolling_resistance = 0.04;
  design.wheel_kg = 18.0;
  design.spring = 13e3;
  design.damper = 1100.0;
  design.travel_m = 0.13;
  design.anti_roll = 5e3;
  design.least_radius_m = 3.4;
  design.four_wheel_drive = true;
  design.drive_n = 4500.0;
  design.power_w = 35e3;
  design.brake_n = 5000.0;
  design.drag = 0.6;
  design.path_smoothing_m = 3.0;
  return design;
}

Trajectory drive_utility(const MotionConfig& config, const World& world, const RayScene& rays, std::uint64_t seed) {
  return drive_wheeled(utility(), config, world, rays, seed);
}

SceneDescription utility_body() {
  MjcfWriter writer;
  writer.box("steel", {-0.9, -0.55, -0.2}, {0.4, 0.55, -0.14});  // the cage's roof
  for (const double y : {-0.6, 0.6}) {
    writer.cylinder("steel", {0.4, y, -0.2}, {0.7, y, -0.9}, 0.03);
    writer.cylinder("steel", {-0.9, y, -0.2}, {-1.0, y, -0.9}, 0.03);
  }
  writer.box("panels_green", {0.5, -0.65, -1.2}, {1.35, 0.65, -0.85});   // bonnet
  writer.box("panels_green", {-1.5, -0.65, -1.2}, {-0.7, 0.65, -0.95});  // loading bed
  return writer.finish("utility", scene_palette(), 30.0, 0.0);
}

}  // namespace

VehicleInfo utility_vehicle() {
  MotionConfig defaults;
  defaults.vehicle = "utility";
  defaults.speed_mps = 4.0;
  defaults.acceleration_mps2 = 1.0;
  defaults.lateral_acceleration_mps2 = 2.0;
  defaults.roughness_m = 0.02;
  return {.name = "utility",
          .summary = "utility vehicle on rough ground to 5 m/s, simulated: suspension, tyres, driver; pack 1.8 m high",
          .defaults = defaults,
          .drive = drive_utility,
          .body = utility_body};
}

}  // namespace plumbline
