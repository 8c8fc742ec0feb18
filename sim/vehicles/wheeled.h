#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "sim/vehicles/tyre.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {

/// A vehicle on four wheels. Its chassis frame: x forward, z up, the origin between the rear wheels' centres at rest.
struct WheeledDesign {
  std::string name;
  double mass_kg = 0.0;                                       ///< of the chassis, without wheels
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();          ///< of the chassis about its centre of mass [kg m^2]
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();   ///< in the chassis frame
  Eigen::Vector3d pack_in_chassis = Eigen::Vector3d::Zero();  ///< where a pack of sensors is bolted on
  double wheelbase_m = 0.0;
  double track_m = 0.0;  ///< between the wheels of an axle
  TyreDesign tyre;
  double wheel_kg = 0.0;

  double spring = 0.0;  ///< of a wheel's suspension [N/m]; 0: rigid
  double damper = 0.0;  ///< [N s/m]
  double travel_m = 0.0;
  double anti_roll = 0.0;  ///< of an axle [N/m of difference]

  enum class Steering {
    kFrontWheels,  ///< Ackermann: all wheels turn about one point
    kPushed        ///< the front wheels are castors; a person at the handle pushes and turns the whole
  };
  Steering steering = Steering::kFrontWheels;
  Eigen::Vector3d handle_in_chassis = Eigen::Vector3d::Zero();
  double step_frequency_hz = 0.0;  ///< of the person who pushes, at full speed
  double step_share = 0.0;         ///< of the push that comes and goes with the steps

  double least_radius_m = 0.0;  ///< of the rear axle's path
  bool four_wheel_drive = false;
  double drive_n = 0.0;
  double power_w = 0.0;
  double brake_n = 0.0;
  double drag = 0.0;  ///< of the air [N s^2/m^2]

  double path_smoothing_m = 4.0;  ///< how far the driver rounds the corners of a route
  double tracking_rad_s = 1.2;    ///< how fast the driver steers back to the path
  double ground_cell_m = 0.1;
};

/// Drives along the path of `config`, a millisecond a step.
/// @throws std::invalid_argument naming the place of the path that is too tight, or where the vehicle left it.
Trajectory drive_wheeled(const WheeledDesign& design, const MotionConfig& config, const World& world,
                         const RayScene& rays, std::uint64_t seed);

}  // namespace plumbline
