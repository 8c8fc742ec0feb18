#include "sim/vehicles/chassis.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "sim/constants.h"

namespace plumbline {
namespace {

constexpr std::array<const char*, 4> kCorners{"front_left", "front_right", "rear_left", "rear_right"};

bool is_front(std::size_t i) { return i < 2; }

std::string text(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

/// What a wheel's spring carries at rest.
double spring_load(const WheeledDesign& design, std::size_t corner) {
  const double share = design.centre_of_mass.x() / design.wheelbase_m;
  return 0.5 * design.mass_kg * kGravity * (is_front(corner) ? share : 1.0 - share);
}

void write_wheel(std::ostream& out, const WheeledDesign& design, std::size_t corner) {
  const double r = design.tyre.radius_m;
  const double across = 0.4 * design.wheel_kg * r * r;
  const double along = 0.7 * design.wheel_kg * r * r;  // most of a wheel's mass is in its rim
  const std::string name = kCorners[corner];
  const Eigen::Vector3d place(is_front(corner) ? design.wheelbase_m : 0.0,
                              (corner % 2 == 0 ? 0.5 : -0.5) * design.track_m, 0.0);
  const bool sprung = design.spring > 0.0;
  const bool steered = design.steering == WheeledDesign::Steering::kFrontWheels && is_front(corner);
  out << "<body pos='" << text(place) << "' name='" << name << "'>";
  if (sprung) {
    out << "<joint name='" << name << "_slide' type='slide' axis='0 0 1' stiffness='" << design.spring << "' damping='"
        << design.damper << "' springref='" << -spring_load(design, corner) / design.spring << "'/>";
  }
  if (steered) {
    out << "<joint name='" << name << "_steer' type='hinge' axis='0 0 1' armature='0.5' damping='150'/>";
  }
  out << "<joint name='" << name << "_spin' type='hinge' axis='0 1 0'/>";
  out << "<inertial pos='0 0 0' mass='" << design.wheel_kg << "' diaginertia='" << text({across, along, across})
      << "'/></body>";
}

std::string mjcf_of(const WheeledDesign& design) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "<mujoco><option timestep='" << Chassis::kStep_s << "'/><worldbody><body name='chassis'><freejoint/>"
      << "<inertial pos='" << text(design.centre_of_mass) << "' mass='" << design.mass_kg << "' diaginertia='"
      << text(design.inertia) << "'/>";
  for (std::size_t corner = 0; corner < 4; ++corner) write_wheel(out, design, corner);
  out << "</body></worldbody>";
  if (design.steering == WheeledDesign::Steering::kFrontWheels) {
    out << "<actuator><position joint='front_left_steer' kp='15000'/><position joint='front_right_steer' kp='15000'/>"
        << "</actuator>";
  }
  out << "</mujoco>";
  return out.str();
}

Eigen::Vector3d vector_at(const mjtNum* values) { return Eigen::Map<const Eigen::Vector3d>(values); }

/// Angular, then linear velocity of a body at its centre of mass, world axes.
Eigen::Matrix<double, 6, 1> velocity_of(const mjModel& model, const mjData& data, int body) {
  Eigen::Matrix<double, 6, 1> velocity;
  mj_objectVelocity(&model, &data, mjOBJ_BODY, body, velocity.data(), 0);
  return velocity;
}

}  // namespace

Chassis::Chassis(const WheeledDesign& design, const Pose& world_from_chassis)
    : design_(design), model_(compile_mjcf(mjcf_of(design))), data_(forward_initial_state(*model_)) {
  chassis_ = mj_name2id(model_.get(), mjOBJ_BODY, "chassis");
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string name = kCorners[i];
    wheel_[i] = mj_name2id(model_.get(), mjOBJ_BODY, name.c_str());
    spin_[i] = model_->jnt_dofadr[mj_name2id(model_.get(), mjOBJ_JOINT, (name + "_spin").c_str())];
    const int slide = mj_name2id(model_.get(), mjOBJ_JOINT, (name + "_slide").c_str());
    slide_place_[i] = slide < 0 ? -1 : model_->jnt_qposadr[slide];
    slide_speed_[i] = slide < 0 ? -1 : model_->jnt_dofadr[slide];
  }
  const Eigen::Quaterniond& q = world_from_chassis.rotation;
  Eigen::Map<Eigen::Vector3d>(data_->qpos) = world_from_chassis.translation;
  Eigen::Map<Eigen::Vector4d>(data_->qpos + 3) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  mj_forward(model_.get(), data_.get());
}

Pose Chassis::pose() const {
  const mjtNum* q = data_->xquat + 4L * chassis_;
  return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), vector_at(data_->xpos + 3L * chassis_)};
}

Eigen::Vector3d Chassis::velocity() const { return vector_at(data_->qvel); }

Eigen::Vector3d Chassis::turn_rate() const { return velocity_of(*model_, *data_, chassis_).head<3>(); }

WheelMotion Chassis::wheel(int i) const {
  const auto k = static_cast<std::size_t>(i);
  WheelMotion wheel;
  wheel.centre = vector_at(data_->xpos + 3L * wheel_[k]);
  wheel.velocity = velocity_of(*model_, *data_, wheel_[k]).tail<3>();
  const mjtNum* matrix = data_->xmat + 9L * wheel_[k];
  wheel.axle = {matrix[1], matrix[4], matrix[7]};
  wheel.spin_rad_s = data_->qvel[spin_[k]];
  return wheel;
}

void Chassis::begin_step() {
  mj_step1(model_.get(), data_.get());
  std::fill_n(data_->xfrc_applied, 6L * model_->nbody, 0.0);
  std::fill_n(data_->qfrc_applied, model_->nv, 0.0);
}

void Chassis::push_wheel(int i, const TyreForce& force) {
  mjtNum* wrench = data_->xfrc_applied + 6L * wheel_[static_cast<std::size_t>(i)];
  Eigen::Map<Eigen::Vector3d>(wrench) += force.force;
  Eigen::Map<Eigen::Vector3d>(wrench + 3) += force.torque;
}

void Chassis::drive_wheel(int i, double torque_nm) {
  data_->qfrc_applied[spin_[static_cast<std::size_t>(i)]] += torque_nm;
}

void Chassis::push(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, const Eigen::Vector3d& place_in_world) {
  const Eigen::Vector3d arm = place_in_world - vector_at(data_->xipos + 3L * chassis_);
  mjtNum* wrench = data_->xfrc_applied + 6L * chassis_;
  Eigen::Map<Eigen::Vector3d>(wrench) += force;
  Eigen::Map<Eigen::Vector3d>(wrench + 3) += torque + arm.cross(force);
}

void Chassis::steer(double left_rad, double right_rad) {
  data_->ctrl[0] = left_rad;
  data_->ctrl[1] = right_rad;
}

void Chassis::add_suspension_forces() {
  constexpr double kStop = 8.0;  // rubber stops beyond the travel, against the spring
  const auto bend = [&](std::size_t i) { return data_->qpos[slide_place_[i]]; };
  for (std::size_t i = 0; i < 4; ++i) {
    const double beyond = std::abs(bend(i)) - design_.travel_m;
    if (beyond > 0.0) data_->qfrc_applied[slide_speed_[i]] -= std::copysign(kStop * design_.spring * beyond, bend(i));
  }
  for (const std::size_t left : {0U, 2U}) {
    const double twist_n = design_.anti_roll * (bend(left) - bend(left + 1));
    data_->qfrc_applied[slide_speed_[left]] -= twist_n;
    data_->qfrc_applied[slide_speed_[left + 1]] += twist_n;
  }
}

void Chassis::finish_step() {
  if (design_.spring > 0.0) add_suspension_forces();
  mj_step2(model_.get(), data_.get());
}

}  // namespace plumbline
