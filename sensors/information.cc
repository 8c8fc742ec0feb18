#include "sensors/information.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/symmetric_eigen.h"

namespace plumbline {
namespace {

// No information at all is a bound of this many limits: large, and still a number.
constexpr double kLargestExcess = 1e6;

Vector6d one_limit(const DegeneracyLimits& limits) {
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(limits.rotation_rad), Eigen::Vector3d::Constant(limits.translation_m);
  return scale;
}

}  // namespace

Matrix6d lidar_information(const std::vector<SurfacePoint>& points, double range_sigma_m) {
  Matrix6d sum = Matrix6d::Zero();
  for (const SurfacePoint& point : points) {
    Vector6d row;
    row << point.position.cross(point.normal), point.normal;
    sum.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  sum = sum.selfadjointView<Eigen::Lower>();
  return sum / (range_sigma_m * range_sigma_m);
}

Matrix6d image_information(const std::vector<Eigen::Vector3d>& points_in_camera, const CameraIntrinsics& camera,
                           double pixel_sigma_px) {
  Matrix6d sum = Matrix6d::Zero();
  for (const Eigen::Vector3d& p : points_in_camera) {
    if (p.z() <= 0.0) continue;
    Eigen::Matrix<double, 2, 3> d_pixel_d_point;
    d_pixel_d_point << camera.fx / p.z(), 0.0, -camera.fx * p.x() / (p.z() * p.z()),  //
        0.0, camera.fy / p.z(), -camera.fy * p.y() / (p.z() * p.z());
    // The point stays in the world, so in the camera it moves against the camera: by p x rotation - translation.
    Eigen::Matrix<double, 3, 6> d_point_d_pose;
    d_point_d_pose << 0.0, -p.z(), p.y(), -1.0, 0.0, 0.0,  //
        p.z(), 0.0, -p.x(), 0.0, -1.0, 0.0,                //
        -p.y(), p.x(), 0.0, 0.0, 0.0, -1.0;
    const Eigen::Matrix<double, 2, 6> rows = d_pixel_d_point * d_point_d_pose;
    sum.noalias() += rows.transpose() * rows;
  }
  return sum / (pixel_sigma_px * pixel_sigma_px);
}

Vector6d DegeneracyLimits::in_limits(const Vector6d& perturbation) const {
  return perturbation.cwiseQuotient(one_limit(*this));
}

int DegeneracyLabel::degenerate() const { return static_cast<int>((excess.array() > 1.0).count()); }

DegeneracyLabel::Class DegeneracyLabel::class_of(double excess) {
  if (excess > kGreyZone) return Class::kDegenerate;
  return excess < 1.0 / kGreyZone ? Class::kWell : Class::kGrey;
}

DegeneracyLabel label(const Matrix6d& information, const DegeneracyLimits& limits) {
  const Vector6d scale = one_limit(limits);
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const SymmetricEigen<Matrix6d> eigen(scaled);
  DegeneracyLabel label;
  constexpr double kLeast = 1.0 / (kLargestExcess * kLargestExcess);
  label.excess = eigen.values.cwiseMax(kLeast).cwiseSqrt().cwiseInverse();
  label.directions = scale.asDiagonal() * eigen.vectors;
  return label;
}

Matrix6d cramer_rao_bound(const Matrix6d& information, const DegeneracyLimits& limits) {
  const DegeneracyLabel bound = label(information, limits);
  return bound.directions * bound.excess.array().square().matrix().asDiagonal() * bound.directions.transpose();
}

}  // namespace plumbline
