#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A rigid transform, named target_from_source: p_target = target_from_source * p_source.
///
/// Six-vectors are [rotation; translation], and perturbations are on the right, in the source frame:
/// retract(d) = { R exp(d_rot), t + R d_trans }, and local() is its inverse.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  Pose operator*(const Pose& other) const;
  Pose inverse() const;

  Pose retract(const Vector6d& perturbation) const;
  /// The perturbation that leads from this pose to `other`: retract(local(other)) == other.
  Vector6d local(const Pose& other) const;
};

/// How a right perturbation of T^-1 ... T moves through T: exp(Ad(T) d) T = T exp(d), in [rotation; translation] order.
Matrix6d adjoint(const Pose& pose);

/// Roll, pitch, yaw [rad] (x forward, y left, z up; R = Rz(yaw) Ry(pitch) Rx(roll); positive pitch looks down).
Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& roll_pitch_yaw);
Eigen::Vector3d rpy_from_rotation(const Eigen::Quaterniond& rotation);

/// The fixed rotation from a camera's optical axes (x right, y down, z forward) to body axes (x forward, y left, z up).
Eigen::Quaterniond body_from_optical_rotation();

}  // namespace plumbline
