#include "estimator/geometry/so3.h"

#include <cmath>

namespace plumbline {
namespace {
// Below this angle [rad] the truncated series is exact to double precision.
constexpr double kSeriesAngle = 1e-4;
}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_vector) {
  const double angle_sq = rotation_vector.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  double half_sinc = 0.5 - angle_sq / 48.0;
  double cosine = 1.0 - angle_sq / 8.0;
  if (angle > kSeriesAngle) {
    half_sinc = std::sin(0.5 * angle) / angle;
    cosine = std::cos(0.5 * angle);
  }
  const Eigen::Vector3d v = half_sinc * rotation_vector;
  return Eigen::Quaterniond(cosine, v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * rotation.vec();
  const double w = sign * rotation.w();
  const double sine = v.norm();
  // angle / sin(angle / 2); the series is 2 (1 + s^2 / 6) for s = sin(angle / 2).
  const double factor = sine < kSeriesAngle ? 2.0 + sine * sine / 3.0 : 2.0 * std::atan2(sine, w) / sine;
  return factor * v;
}

Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& rotation_vector) {
  const double angle_sq = rotation_vector.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  double a = 0.5 - angle_sq / 24.0;
  double b = 1.0 / 6.0 - angle_sq / 120.0;
  if (angle > kSeriesAngle) {
    a = (1.0 - std::cos(angle)) / angle_sq;
    b = (angle - std::sin(angle)) / (angle_sq * angle);
  }
  const Eigen::Matrix3d w = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() - a * w + b * w * w;
}

}  // namespace plumbline
