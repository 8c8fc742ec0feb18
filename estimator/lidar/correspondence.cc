#include "estimator/lidar/correspondence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace plumbline {
namespace {

constexpr int kLeastClutterNeighbours = 6;
// Least over greatest eigenvalue of scatter: of a sheet three times as wide as it is thick it would be 0.1.
constexpr double kLeastThickness = 0.05;

struct Scatter {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();  // of the covariance, ascending
  Eigen::Matrix3d eigenvectors = Eigen::Matrix3d::Identity();
};

/// Positions of some neighbours, nearest first.
struct Positions {
  std::array<Eigen::Vector3d, NearestSamples::kCapacity> at;
  int count = 0;

  void push(const Eigen::Vector3d& position) { at[static_cast<std::size_t>(count++)] = position; }
  const Eigen::Vector3d& operator[](int i) const { return at[static_cast<std::size_t>(i)]; }
};

Positions all_positions(const NearestSamples& neighbours) {
  Positions positions;
  for (int i = 0; i < neighbours.size(); ++i) positions.push(neighbours[i].position);
  return positions;
}

/// The neighbours within `reach` of the line through the nearest one and another that has the most such neighbours. Two
/// edges of a door frame run a few centimetres apart; a line through the neighbours of both would be neither.
Positions largest_line(const Positions& from, double reach) {
  Positions best;
  for (int j = 1; j < from.count; ++j) {
    const Eigen::Vector3d along = from[j] - from[0];
    const double length = along.norm();
    if (length <= 0.0) continue;
    Positions on_line;
    for (int i = 0; i < from.count; ++i) {
      if ((from[i] - from[0]).cross(along).norm() <= reach * length) on_line.push(from[i]);
    }
    if (on_line.count > best.count) best = on_line;
  }
  return best;
}

Scatter scatter_of(const Positions& positions) {
  Scatter result;
  const double share = 1.0 / positions.count;
  for (int i = 0; i < positions.count; ++i) result.centroid += share * positions[i];
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < positions.count; ++i) {
    const Eigen::Vector3d d = positions[i] - result.centroid;
    covariance += share * d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  result.eigenvalues = eigen.eigenvalues().cwiseMax(0.0);
  result.eigenvectors = eigen.eigenvectors();
  return result;
}

/// Of the neighbours' own normals, turned to the side of a given one; zero where they have none.
Eigen::Vector3d mean_normal(const NearestSamples& neighbours, const Eigen::Vector3d& side) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < neighbours.size(); ++i) {
    const Eigen::Vector3d normal = neighbours[i].normal.cast<double>();
    sum += normal.dot(side) < 0.0 ? Eigen::Vector3d(-normal) : normal;
  }
  return sum.stableNormalized();
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

std::optional<MapPlane> fit_plane(const NearestSamples& neighbours, const FitLimits& limits,
                                  const Eigen::Vector3d& used_at) {
  const Positions points = all_positions(neighbours);
  if (points.count < limits.least_neighbours) return std::nullopt;
  const Scatter s = scatter_of(points);
  // Neighbours on a single ring are collinear: their second eigenvalue is as small as the first.
  if (s.eigenvalues[1] < limits.least_spread_m * limits.least_spread_m) return std::nullopt;
  if (s.eigenvalues[0] * limits.ratio > s.eigenvalues[1]) return std::nullopt;
  const double tilt = tilt_sigma(s.eigenvalues[0], s.eigenvalues[1], points.count, 3, limits.map_sigma_m);
  if (tilt > limits.largest_tilt_sigma) return std::nullopt;
  // A lone ring's trace on the ground is a strip; what is matched a metre beside it would take its twist for a slope.
  if (std::abs(s.eigenvectors.col(1).dot(used_at - s.centroid)) * tilt > limits.largest_offset_sigma_m) {
    return std::nullopt;
  }
  const Eigen::Vector3d normal = s.eigenvectors.col(0);
  if (mean_normal(neighbours, normal).cross(normal).norm() > limits.largest_disagreement) return std::nullopt;
  for (int i = 0; i < points.count; ++i) {
    if (std::abs(normal.dot(points[i] - s.centroid)) > limits.largest_residual_m) return std::nullopt;
  }
  return MapPlane{normal, normal.dot(s.centroid)};
}

std::optional<MapLine> fit_line(const NearestSamples& neighbours, const FitLimits& limits) {
  if (neighbours.size() < limits.least_neighbours) return std::nullopt;
  const Positions points = largest_line(all_positions(neighbours), limits.largest_residual_m);
  if (points.count < limits.least_neighbours) return std::nullopt;
  const Scatter s = scatter_of(points);
  if (s.eigenvalues[2] < limits.least_spread_m * limits.least_spread_m) return std::nullopt;
  if (s.eigenvalues[1] * limits.ratio > s.eigenvalues[2]) return std::nullopt;
  const double tilt = tilt_sigma(s.eigenvalues[1], s.eigenvalues[2], points.count, 2, limits.map_sigma_m);
  if (tilt > limits.largest_tilt_sigma) return std::nullopt;
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
  rows.add(
      line.across_1.dot(offset) / sigma_m, component_jacobian(line.across_1, point_in_body, world_from_body) / sigma_m,
      line.across_2.dot(offset) / sigma_m, component_jacobian(line.across_2, point_in_body, world_from_body) / sigma_m);
}

std::optional<MapLine> line_through_clutter(const NearestSamples& neighbours, const Eigen::Vector3d& unseen) {
  if (neighbours.size() < kLeastClutterNeighbours) return std::nullopt;
  const Eigen::Vector3d spread = scatter_of(all_positions(neighbours)).eigenvalues;
  if (spread[0] < kLeastThickness * spread[2]) return std::nullopt;
  const Eigen::Vector3d across = unseen.unitOrthogonal();
  return MapLine{neighbours[0].position, across, unseen.cross(across).normalized()};
}

}  // namespace plumbline
