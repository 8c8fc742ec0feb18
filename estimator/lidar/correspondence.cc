#include "estimator/lidar/correspondence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

struct Scatter {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();  // of the covariance, ascending
  Eigen::Matrix3d eigenvectors = Eigen::Matrix3d::Identity();
};

Scatter scatter_of(const NearestSamples& neighbours) {
  Scatter result;
  const double share = 1.0 / neighbours.size();
  for (int i = 0; i < neighbours.size(); ++i) result.centroid += share * neighbours[i].position;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < neighbours.size(); ++i) {
    const Eigen::Vector3d d = neighbours[i].position - result.centroid;
    covariance += share * d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  result.eigenvalues = eigen.eigenvalues().cwiseMax(0.0);
  result.eigenvectors = eigen.eigenvectors();
  return result;
}

/// Standard deviation of the fitted direction's tilt: the residuals' noise (never believed below the map's) over the
/// lever that the neighbours give. Tilted normals are what leaks false information into a tunnel's axis.
double tilt_sigma(double residual_variance, double spread_variance, int neighbours, int unknowns, double map_sigma_m) {
  const double freedom = std::max(1, neighbours - unknowns);
  const double noise = std::max(residual_variance * neighbours / freedom, map_sigma_m * map_sigma_m);
  return std::sqrt(noise / (neighbours * spread_variance));
}

/// Row of a point's component along a world direction: d/dphi (n . R p) = -n^T R [p]x, d/dt = n^T R.
Vector6d component_jacobian(const Eigen::Vector3d& direction, const Eigen::Vector3d& point_in_body,
                            const Pose& world_from_body) {
  const Eigen::Vector3d in_body = world_from_body.rotation.conjugate() * direction;
  Vector6d jacobian;
  jacobian << point_in_body.cross(in_body), in_body;
  return jacobian;
}

}  // namespace

std::optional<MapPlane> fit_plane(const NearestSamples& neighbours, const FitLimits& limits) {
  const int n = neighbours.size();
  if (n < limits.least_neighbours) return std::nullopt;
  const Scatter s = scatter_of(neighbours);
  // Neighbours on a single ring are collinear: their second eigenvalue is as small as the first.
  if (s.eigenvalues[1] < limits.least_spread_m * limits.least_spread_m) return std::nullopt;
  if (s.eigenvalues[0] * limits.ratio > s.eigenvalues[1]) return std::nullopt;
  if (tilt_sigma(s.eigenvalues[0], s.eigenvalues[1], n, 3, limits.map_sigma_m) > limits.largest_tilt_sigma) {
    return std::nullopt;
  }
  const Eigen::Vector3d normal = s.eigenvectors.col(0);
  for (int i = 0; i < n; ++i) {
    if (std::abs(normal.dot(neighbours[i].position - s.centroid)) > limits.largest_residual_m) return std::nullopt;
  }
  return MapPlane{normal, normal.dot(s.centroid)};
}

std::optional<MapLine> fit_line(const NearestSamples& neighbours, const FitLimits& limits) {
  const int n = neighbours.size();
  if (n < limits.least_neighbours) return std::nullopt;
  const Scatter s = scatter_of(neighbours);
  if (s.eigenvalues[2] < limits.least_spread_m * limits.least_spread_m) return std::nullopt;
  if (s.eigenvalues[1] * limits.ratio > s.eigenvalues[2]) return std::nullopt;
  if (tilt_sigma(s.eigenvalues[1], s.eigenvalues[2], n, 2, limits.map_sigma_m) > limits.largest_tilt_sigma) {
    return std::nullopt;
  }
  const Eigen::Vector3d direction = s.eigenvectors.col(2);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d d = neighbours[i].position - s.centroid;
    if (d.cross(direction).norm() > limits.largest_residual_m) return std::nullopt;
  }
  return MapLine{s.centroid, s.eigenvectors.col(0), s.eigenvectors.col(1)};
}

void add_plane_row(const Eigen::Vector3d& point_in_body, const MapPlane& plane, const Pose& world_from_body,
                   double sigma_m, ResidualRows& rows) {
  const double distance = plane.normal.dot(world_from_body * point_in_body) - plane.offset;
  rows.add(distance / sigma_m, component_jacobian(plane.normal, point_in_body, world_from_body) / sigma_m);
}

void add_line_rows(const Eigen::Vector3d& point_in_body, const MapLine& line, const Pose& world_from_body,
                   double sigma_m, ResidualRows& rows) {
  const Eigen::Vector3d offset = world_from_body * point_in_body - line.point;
  rows.add(line.across_1.dot(offset) / sigma_m,
           component_jacobian(line.across_1, point_in_body, world_from_body) / sigma_m,
           line.across_2.dot(offset) / sigma_m,
           component_jacobian(line.across_2, point_in_body, world_from_body) / sigma_m);
}

}  // namespace plumbline
