#pragma once

#include <array>

#include "estimator/geometry/pose.h"
#include "sim/mjcf_model.h"
#include "sim/random_stream.h"
#include "sim/vehicles/flight_reference.h"

namespace plumbline {

/// A quadrotor's figures. Rotors in the order front left, front right, rear right, rear left; front left and rear right
/// turn clockwise seen from above.
struct RotorCraftDesign {
  double mass_kg = 1.6;
  Eigen::Vector3d inertia{0.012, 0.012, 0.022};  ///< [kg m^2]
  double arm_m = 0.2;                            ///< from the middle to a rotor, at 45 degrees
  double thrust_per_speed2 = 1.4e-5;             ///< [N s^2/rad^2]
  double torque_per_thrust_m = 0.016;            ///< of a rotor's drag
  double most_thrust_n = 17.0;                   ///< of a rotor
  double least_thrust_n = 0.15;
  double rotor_lag_s = 0.025;  ///< of the first order in which a rotor's speed follows
  double drag = 0.3;           ///< of the whole against the air [N s/m]
};

/// What the controller wants.
struct Wrench {
  double thrust_n = 0.0;                             ///< along the craft's z
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< in the craft's axes [N m]
};

/// Of the controller. By themselves for a state known at once and exactly.
struct TrackingGains {
  double place = 30.0;      ///< [1/s^2]
  double velocity = 10.0;   ///< [1/s]
  double attitude = 900.0;  ///< [1/s^2]
  double rate = 50.0;       ///< [1/s]
};

/// A craft as it flies: a free body in MuJoCo, pushed by its rotors and the wind.
class RotorCraft {
 public:
  static constexpr double kStep_s = 1e-3;

  /// Starts in hover.
  RotorCraft(const RotorCraftDesign& design, const Pose& world_from_craft);

  /// Its pose, velocity and rate; the acceleration fields stay zero.
  FlightState state() const;
  /// The rotors are sent the speeds that would give `wanted`, as near as they can, and follow with their lag.
  void step(const Wrench& wanted, const Eigen::Vector3d& wind);

 private:
  RotorCraftDesign design_;
  MjModelPtr model_;
  MjDataPtr data_;
  int body_ = -1;
  std::array<double, 4> speed_{};         // of the rotors [rad/s]
  std::array<double, 4> wanted_speed_{};  // at the last step
};

/// Geometric tracking control on SE(3) (Lee, Leok, McClamroch, CDC 2010), with the reference's own derivatives fed
/// forward.
Wrench track(const RotorCraftDesign& design, const FlightState& now, const FlightState& wanted,
             const TrackingGains& gains = {});

}  // namespace plumbline
