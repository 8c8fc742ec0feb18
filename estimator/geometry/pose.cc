#include "estimator/geometry/pose.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/so3.h"

namespace plumbline {

Pose Pose::operator*(const Pose& other) const {
  return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
  return {inverse_rotation, -(inverse_rotation * translation)};
}

Pose Pose::retract(const Vector6d& perturbation) const {
  return {(rotation * exp_so3(perturbation.head<3>())).normalized(),
          translation + rotation * perturbation.tail<3>().eval()};
}

Vector6d Pose::local(const Pose& other) const {
  Vector6d d;
  d.head<3>() = log_so3(rotation.conjugate() * other.rotation);
  d.tail<3>() = rotation.conjugate() * (other.translation - translation);
  return d;
}

Matrix6d adjoint(const Pose& pose) {
  const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = r;
  ad.bottomRightCorner<3, 3>() = r;
  ad.bottomLeftCorner<3, 3>() = skew(pose.translation) * r;
  return ad;
}

Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

Eigen::Quaterniond body_from_optical_rotation() {
  Eigen::Matrix3d r;
  r << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(r);
}

}  // namespace plumbline
