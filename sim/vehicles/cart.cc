#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/palette.h"
#include "sim/vehicles/ground_vehicles.h"

namespace plumbline {
namespace {

// A trolley on hard small wheels, castors in front, pushed by the handle behind.
WheeledDesign cart() {
  WheeledDesign design;
  design.name = "cart";
  design.mass_kg = 36.0;
  design.inertia = {3.0, 4.5, 4.0};
  design.centre_of_mass = {0.35, 0.0, 0.35};
  design.pack_in_chassis = {0.4, 0.0, 1.12};  // on a mast, 1.2 m above the floor
  design.wheelbase_m = 0.7;
  design.track_m = 0.5;
  design.tyre.radius_m = 0.08;
  design.tyre.stiffness = 60e3;
  design.tyre.damping = 150.0;
  design.tyre.slip_stiffness = 12.0;
  design.tyre.relaxation_m = 0.04;
  design.tyre.friction = 0.8;
  design.tyre.rolling_resistance = 0.02;
  design.wheel_kg = 0.6;
  design.steering = WheeledDesign::Steering::kPushed;
  design.handle_in_chassis = {-0.15, 0.0, 0.8};
  design.step_frequency_hz = 1.8;
  design.step_share = 0.05;
  design.least_radius_m = 0.6;
  design.drive_n = 120.0;
  design.power_w = 300.0;
  design.brake_n = 120.0;
  design.path_smoothing_m = 2.0;
  design.tracking_rad_s = 1.5;
  design.ground_cell_m = 0.05;
  return design;
}

Trajectory drive_cart(const MotionConfig& config, const World& world, const RayScene& rays, std::uint64_t seed) {
  return drive_wheeled(cart(), config, world, rays, seed);
}

SceneDescription cart_body() {
  MjcfWriter writer;
  writer.cylinder("steel", {0.0, 0.0, -0.75}, {0.0, 0.0, -0.03}, 0.02);  // mast
  writer.box("panels_blue", {-0.5, -0.28, -1.0}, {0.4, 0.28, -0.75});
  for (const double y : {-0.25, 0.25}) writer.cylinder("steel", {-0.5, y, -0.75}, {-0.55, y, -0.3}, 0.015);
  writer.cylinder("steel", {-0.55, -0.25, -0.3}, {-0.55, 0.25, -0.3}, 0.015);  // handle
  writer.capsule("panels_grey", {-1.0, 0.0, -0.3}, {-0.98, 0.0, 0.15}, 0.19);  // who pushes it
  writer.ellipsoid("plaster", {-0.97, 0.0, 0.46}, {0.1, 0.08, 0.12});
  return writer.finish("cart", scene_palette(), 30.0, 0.0);
}

}  // namespace

VehicleInfo cart_vehicle() {
  MotionConfig defaults;
  defaults.vehicle = "cart";
  defaults.speed_mps = 1.4;
  defaults.acceleration_mps2 = 0.5;
  defaults.lateral_acceleration_mps2 = 0.8;
  defaults.roughness_m = 0.0005;
  return {.name = "cart",
          .summary = "cart pushed over the floor on small hard wheels, simulated; pack on a mast, 1.2 m high",
          .defaults = defaults,
          .drive = drive_cart,
          .body = cart_body};
}

}  // namespace plumbline
