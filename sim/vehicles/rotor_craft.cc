#include "sim/vehicles/rotor_craft.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

#include "estimator/geometry/so3.h"
#include "sim/constants.h"

namespace plumbline {
namespace {

// Ahead, left and drag torque of each rotor.
constexpr double kAhead[4] = {1.0, 1.0, -1.0, -1.0};
constexpr double kLeft[4] = {1.0, -1.0, -1.0, 1.0};
constexpr double kTwist[4] = {1.0, -1.0, 1.0, -1.0};  // of the body; a rotor drags it against its own turning

std::string mjcf_of(const RotorCraftDesign& design) {
  std::ostringstream sites;
  std::ostringstream motors;
  sites.imbue(std::locale::classic());
  motors.imbue(std::locale::classic());
  const double offset_m = design.arm_m * std::sqrt(0.5);
  for (int i = 0; i < 4; ++i) {
    sites << "<site name='rotor" << i << "' pos='" << kAhead[i] * offset_m << ' ' << kLeft[i] * offset_m << " 0'/>";
    motors << "<motor site='rotor" << i << "' gear='0 0 1 0 0 " << kTwist[i] * design.torque_per_thrust_m << "'/>";
  }
  std::ostringstream out;
  out.imbue(std::locale::classic());
  // Runge-Kutta: at six turns a second and 1 ms, Euler's method would lose the gyroscopic torques' second order.
  out << "<mujoco><option timestep='" << RotorCraft::kStep_s << "' integrator='RK4'/><worldbody><body name='craft'>"
      << "<freejoint/><inertial pos='0 0 0' mass='" << design.mass_kg << "' diaginertia='" << design.inertia.x() << ' '
      << design.inertia.y() << ' ' << design.inertia.z() << "'/>" << sites.str() << "</body></worldbody><actuator>"
      << motors.str() << "</actuator></mujoco>";
  return out.str();
}

/// The thrusts that together make a wrench, for four rotors at 45 degrees.
std::array<double, 4> shared_out(const RotorCraftDesign& design, const Wrench& wanted) {
  const double offset_m = design.arm_m * std::sqrt(0.5);
  std::array<double, 4> thrust{};
  // Turning about the vertical is what the craft gives up first: it needs much of a rotor's range for little torque.
  double yaw_share = 1.0;
  for (int pass = 0; pass < 2; ++pass) {
    double beyond = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      thrust[i] =
          0.25 * (wanted.thrust_n + kLeft[i] * wanted.torque.x() / offset_m - kAhead[i] * wanted.torque.y() / offset_m +
                  yaw_share * kTwist[i] * wanted.torque.z() / design.torque_per_thrust_m);
      beyond = std::max({beyond, thrust[i] - design.most_thrust_n, design.least_thrust_n - thrust[i]});
    }
    const double yaw_n = 0.25 * std::abs(wanted.torque.z()) / design.torque_per_thrust_m;
    if (beyond <= 0.0 || yaw_n <= 0.0) break;
    yaw_share = std::max(0.0, 1.0 - beyond / yaw_n);
  }
  for (double& n : thrust) n = std::clamp(n, design.least_thrust_n, design.most_thrust_n);
  return thrust;
}

}  // namespace

RotorCraft::RotorCraft(const RotorCraftDesign& design, const Pose& world_from_craft)
    : design_(design), model_(compile_mjcf(mjcf_of(design))), data_(forward_initial_state(*model_)) {
  body_ = mj_name2id(model_.get(), mjOBJ_BODY, "craft");
  const Eigen::Quaterniond& q = world_from_craft.rotation;
  Eigen::Map<Eigen::Vector3d>(data_->qpos) = world_from_craft.translation;
  Eigen::Map<Eigen::Vector4d>(data_->qpos + 3) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  speed_.fill(std::sqrt(0.25 * design.mass_kg * kGravity / design.thrust_per_speed2));
  wanted_speed_ = speed_;
}

FlightState RotorCraft::state() const {
  FlightState state;
  state.position = Eigen::Map<const Eigen::Vector3d>(data_->qpos);
  const mjtNum* q = data_->qpos + 3;
  state.attitude = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  state.velocity = Eigen::Map<const Eigen::Vector3d>(data_->qvel);
  state.rate = Eigen::Map<const Eigen::Vector3d>(data_->qvel + 3);  // MuJoCo's free joints turn in their own axes
  return state;
}

void RotorCraft::step(const Wrench& wanted, const Eigen::Vector3d& wind) {
  const std::array<double, 4> thrust = shared_out(design_, wanted);
  const double most = std::sqrt(design_.most_thrust_n / design_.thrust_per_speed2);
  for (std::size_t i = 0; i < 4; ++i) {
    const double speed = std::sqrt(thrust[i] / design_.thrust_per_speed2);
    // Sent ahead by the lag, as flight controllers do, within what the motor can.
    const double sent = std::clamp(speed + design_.rotor_lag_s * (speed - wanted_speed_[i]) / kStep_s, 0.0, most);
    wanted_speed_[i] = speed;
    speed_[i] += (sent - speed_[i]) * -std::expm1(-kStep_s / design_.rotor_lag_s);
    data_->ctrl[i] = design_.thrust_per_speed2 * speed_[i] * speed_[i];
  }
  const Eigen::Vector3d velocity = Eigen::Map<const Eigen::Vector3d>(data_->qvel);
  Eigen::Map<Eigen::Vector3d>(data_->xfrc_applied + 6L * body_) = design_.drag * (wind - velocity);
  mj_step(model_.get(), data_.get());
}

Wrench track(const RotorCraftDesign& design, const FlightState& now, const FlightState& wanted,
             const TrackingGains& gains) {
  const Eigen::Vector3d push = design.mass_kg * (wanted.acceleration + kGravity * Eigen::Vector3d::UnitZ() +
                                                 gains.place * (wanted.position - now.position) +
                                                 gains.velocity * (wanted.velocity - now.velocity)) +
                               design.drag * wanted.velocity;
  // The commanded attitude: the thrust's direction, and the reference's forward as near as that leaves it.
  const Eigen::Vector3d z = push.normalized();
  const Eigen::Vector3d y = z.cross(Eigen::Vector3d(wanted.attitude * Eigen::Vector3d::UnitX())).normalized();
  Eigen::Matrix3d commanded;
  commanded << y.cross(z), y, z;

  const Eigen::Matrix3d world_from_craft = now.attitude.toRotationMatrix();
  const Eigen::Matrix3d craft_from_commanded = world_from_craft.transpose() * commanded;
  const Eigen::Matrix3d off = craft_from_commanded.transpose() - craft_from_commanded;
  const Eigen::Vector3d attitude_error = 0.5 * Eigen::Vector3d(off(2, 1), off(0, 2), off(1, 0));
  const Eigen::Vector3d rate = craft_from_commanded * wanted.rate;
  const Eigen::Vector3d rate_error = now.rate - rate;
  const Eigen::Vector3d turning = -gains.attitude * attitude_error - gains.rate * rate_error +
                                  craft_from_commanded * wanted.rate_change - now.rate.cross(rate);
  const Eigen::Vector3d momentum = design.inertia.cwiseProduct(now.rate);
  return {push.dot(world_from_craft.col(2)), design.inertia.cwiseProduct(turning) + now.rate.cross(momentum)};
}

}  // namespace plumbline
