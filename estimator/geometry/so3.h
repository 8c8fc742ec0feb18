#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rotations as used everywhere: rotation vectors [rad], unit quaternions, perturbations on the right,
/// R <- R exp([phi]x).
namespace plumbline {

/// The cross-product matrix: skew(a) * b == a.cross(b).
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// exp: rotation vector -> unit quaternion, by series near zero (Rodrigues, thesis eq. 3.7).
Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_vector);

/// log: unit quaternion -> rotation vector with norm in [0, pi].
Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation);

/// Right Jacobian: exp(phi + d) ~= exp(phi) exp(J_r(phi) d).
Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& rotation_vector);

}  // namespace plumbline
