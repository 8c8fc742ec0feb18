#include "sim/rig_driver.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace plumbline {
namespace {

constexpr std::int64_t kKnot_ns = 10'000'000;
// Geodesic interpolation between steps is off by at most a dt^2 / 8: 5 um at 1 g.
constexpr std::int64_t kStep_ns = 2'000'000;

}  // namespace

Trajectory mounted_on(const Trajectory& world_from_vehicle, const Pose& vehicle_from_pack) {
  const std::int64_t knot_ns = std::min(kKnot_ns, world_from_vehicle.knot_ns());
  std::vector<PoseTrack::Stamped> poses;
  for (std::int64_t stamp_ns = world_from_vehicle.start_ns(); stamp_ns <= world_from_vehicle.end_ns();
       stamp_ns += knot_ns) {
    poses.push_back({stamp_ns, world_from_vehicle.pose(stamp_ns) * vehicle_from_pack});
  }
  return Trajectory(poses);
}

RigDriver::RigDriver(const Trajectory& world_from_body)
    : model_(compile_mjcf("<mujoco><worldbody/></mujoco>")),
      data_(forward_initial_state(*model_)),
      trajectory_(world_from_body),
      rig_body_(mj_name2id(model_.get(), mjOBJ_BODY, kRigBodyName)) {
  step_to(0);
}

RigDriver::~RigDriver() = default;

void RigDriver::advance_to(std::int64_t stamp_ns) {
  while (track_.last_ns() < stamp_ns) step_to(track_.last_ns() + kStep_ns);
}

void RigDriver::step_to(std::int64_t stamp_ns) {
  const Pose target = trajectory_.pose(stamp_ns);
  const int mocap = model_->body_mocapid[rig_body_];
  Eigen::Map<Eigen::Vector3d>(data_->mocap_pos + 3 * mocap) = target.translation;
  const Eigen::Quaterniond& q = target.rotation;
  Eigen::Map<Eigen::Vector4d>(data_->mocap_quat + 4 * mocap) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  data_->time = 1e-9 * static_cast<double>(stamp_ns);
  mj_kinematics(model_.get(), data_.get());

  const mjtNum* position = data_->xpos + 3 * rig_body_;
  const mjtNum* quaternion = data_->xquat + 4 * rig_body_;
  track_.push(stamp_ns, {Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]),
                         Eigen::Vector3d(position[0], position[1], position[2])});
}

}  // namespace plumbline
