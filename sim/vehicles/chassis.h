#pragma once

#include <array>

#include "estimator/geometry/pose.h"
#include "sim/mjcf_model.h"
#include "sim/vehicles/wheeled.h"

namespace plumbline {

/// The bodies of a four-wheeled vehicle in MuJoCo: a free chassis and, on each corner, the suspension's slide, the
/// front wheels' steering and the wheel's spin. Wheels in the order front left, front right, rear left, rear right.
class Chassis {
 public:
  static constexpr double kStep_s = 1e-3;

  Chassis(const WheeledDesign& design, const Pose& world_from_chassis);

  Pose pose() const;                  ///< world_from_chassis
  Eigen::Vector3d velocity() const;   ///< of the chassis frame's origin, world
  Eigen::Vector3d turn_rate() const;  ///< world
  WheelMotion wheel(int i) const;

  // What acts until the next step; begin_step clears it.
  void begin_step();
  void push_wheel(int i, const TyreForce& force);
  void drive_wheel(int i, double torque_nm);
  void push(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, const Eigen::Vector3d& place_in_world);
  void steer(double left_rad, double right_rad);  ///< where the front wheels are asked to point
  void finish_step();

 private:
  void add_suspension_forces();

  WheeledDesign design_;
  MjModelPtr model_;
  MjDataPtr data_;
  int chassis_ = -1;
  std::array<int, 4> wheel_{};        // bodies
  std::array<int, 4> spin_{};         // degrees of freedom
  std::array<int, 4> slide_place_{};  // index into qpos, or -1
  std::array<int, 4> slide_speed_{};  // index into qvel
};

}  // namespace plumbline
