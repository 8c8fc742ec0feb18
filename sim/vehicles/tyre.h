#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/ground.h"

namespace plumbline {

/// A wheel's rubber. Grip grows with the load; the slip stiffness builds up over the relaxation length, which also
/// makes the tyre a spring at standstill (single contact point model: Pacejka, Tire and Vehicle Dynamics, ch. 7).
struct TyreDesign {
  double radius_m = 0.31;
  double stiffness = 200e3;      ///< radial [N/m]
  double damping = 300.0;        ///< radial [N s/m]
  double slip_stiffness = 18.0;  ///< force by load and slip [1/rad], along and across
  double relaxation_m = 0.3;
  double friction = 1.0;              ///< the most that force may be of the load
  double rolling_resistance = 0.012;  ///< of the load
  bool castor = false;                ///< swivels freely: no force across
};

/// A wheel as it moves, world axes.
struct WheelMotion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle = Eigen::Vector3d::UnitY();  ///< to the left, unit
  double spin_rad_s = 0.0;                          ///< about the axle, positive forward
};

/// What the ground does to a wheel at its centre, world axes.
struct TyreForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]
  double load_n = 0.0;                               ///< 0: off the ground
};

/// Where a wheel touches the ground.
struct Contact {
  double depth_m = 0.0;  ///< how far the undeformed wheel reaches into the ground
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// A rigid wheel of this radius rolled over the ground touches what is in its way, not only what is under its centre.
std::optional<Contact> contact_of(const TyreDesign& tyre, const WheelMotion& wheel, Ground& ground, double route_z);

/// One wheel's tyre with its deflection.
class Tyre {
 public:
  explicit Tyre(const TyreDesign& design) : design_(design) {}
  /// Advances the deflection by dt_s.
  TyreForce step(const WheelMotion& wheel, Ground& ground, double route_z, double dt_s);

 private:
  /// Torque against the spin [N m].
  double rolling_resistance(double spin_rad_s, double load_n, double dt_s);

  TyreDesign design_;
  double twist_rad_ = 0.0;                                // of the wheel since it stood
  Eigen::Vector2d deflection_ = Eigen::Vector2d::Zero();  // of the contact patch, forward and left [m]
};

}  // namespace plumbline
