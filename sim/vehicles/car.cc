#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"
#include "sim/vehicles/ground_vehicles.h"

namespace plumbline {
namespace {

// A family car: figures of the middle of its class. The suspension heaves at 1.4 Hz.
WheeledDesign car() {
  WheeledDesign design;
  design.name = "car";
  design.mass_kg = 1250.0;
  design.inertia = {480.0, 1900.0, 2100.0};
  design.centre_of_mass = {1.4, 0.0, 0.25};
  design.pack_in_chassis = {1.2, 0.0, 1.39};  // on the roof, 1.7 m above the road
  design.wheelbase_m = 2.7;
  design.track_m = 1.55;
  design.wheel_kg = 20.0;
  design.spring = 24e3;
  design.damper = 1900.0;
  design.travel_m = 0.09;
  design.anti_roll = 12e3;
  design.least_radius_m = 5.0;
  design.drive_n = 5000.0;
  design.power_w = 140e3;
  design.brake_n = 11e3;
  design.drag = 0.4;
  return design;
}

Trajectory drive_car(const MotionConfig& config, const World& world, const RayScene& rays, std::uint64_t seed) {
  return drive_wheeled(car(), config, world, rays, seed);
}

/// What a pack on the roof can see of the car: roof, bonnet, boot and wings.
SceneDescription car_body() {
  MjcfWriter writer;
  writer.box("car_grey", {-0.9, -0.62, -0.35}, {0.55, 0.62, -0.2});   // roof
  writer.box("car_grey", {0.5, -0.75, -0.85}, {2.35, 0.75, -0.7});    // bonnet
  writer.box("car_grey", {-2.0, -0.75, -0.85}, {-1.1, 0.75, -0.65});  // boot
  writer.box("car_grey", {-2.0, -0.85, -1.35}, {2.4, 0.85, -0.85});
  writer.box("steel", {-0.3, -0.5, -0.2}, {-0.25, 0.5, -0.16});  // the roof rack's bars
  writer.box("steel", {0.25, -0.5, -0.2}, {0.3, 0.5, -0.16});
  return writer.finish("car", scene_palette(), 30.0, 0.0);
}

}  // namespace

VehicleInfo car_vehicle() {
  MotionConfig defaults;
  defaults.vehicle = "car";
  defaults.speed_mps = 13.0;
  defaults.acceleration_mps2 = 2.0;
  defaults.lateral_acceleration_mps2 = 3.0;
  defaults.roughness_m = 0.003;
  return {.name = "car",
          .summary = "passenger car to 33 m/s, simulated: suspension, tyres, driver; pack on the roof, 1.7 m high",
          .defaults = defaults,
          .drive = drive_car,
          .body = car_body};
}

}  // namespace plumbline
