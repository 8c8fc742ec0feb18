#include "sim/analytic_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The part of a line that lies inside a convex solid; empty when enter > leave.
struct Chord {
  double enter = kInfinity;
  double leave = -kInfinity;
};

Chord intersection(const Chord& a, const Chord& b) { return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)}; }

// Only of chords whose union is a chord again.
Chord hull(const Chord& a, const Chord& b) {
  if (a.enter > a.leave) return b;
  if (b.enter > b.leave) return a;
  return {std::min(a.enter, b.enter), std::max(a.leave, b.leave)};
}

// Where |origin + t direction| <= radius, in as many dimensions as the vectors have. Works from the line's nearest
// point to the centre, so that a far origin costs no digits.
template <typename Vector>
Chord chord_of_ball(const Vector& origin, const Vector& direction, double radius) {
  const double length_squared = direction.squaredNorm();
  if (length_squared == 0.0) return origin.norm() <= radius ? Chord{-kInfinity, kInfinity} : Chord{};
  const double middle = -origin.dot(direction) / length_squared;
  const double half_squared = radius * radius - (origin + middle * direction).squaredNorm();
  if (half_squared < 0.0) return {};
  const double half = std::sqrt(half_squared / length_squared);
  return {middle - half, middle + half};
}

Chord chord_of_slab(double origin, double direction, double half_width) {
  if (direction == 0.0) return std::abs(origin) <= half_width ? Chord{-kInfinity, kInfinity} : Chord{};
  const double a = (-half_width - origin) / direction;
  const double b = (half_width - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

Chord chord_of_cylinder(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double radius,
                        double half_length) {
  const Eigen::Vector2d flat_origin = origin.head<2>();
  const Eigen::Vector2d flat_direction = direction.head<2>();
  return intersection(chord_of_ball(flat_origin, flat_direction, radius),
                      chord_of_slab(origin.z(), direction.z(), half_length));
}

Chord chord_of_capsule(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double radius,
                       double half_length) {
  const Eigen::Vector3d to_cap(0.0, 0.0, half_length);
  const Eigen::Vector3d from_top = origin - to_cap;
  const Eigen::Vector3d from_bottom = origin + to_cap;
  const Chord caps = hull(chord_of_ball(from_top, direction, radius), chord_of_ball(from_bottom, direction, radius));
  return hull(caps, chord_of_cylinder(origin, direction, radius, half_length));
}

Chord chord_of_ellipsoid(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         const Eigen::Vector3d& semi_axes) {
  const Eigen::Vector3d unit_origin = origin.cwiseQuotient(semi_axes);
  const Eigen::Vector3d unit_direction = direction.cwiseQuotient(semi_axes);
  return chord_of_ball(unit_origin, unit_direction, 1.0);
}

Chord chord_of_solid(const AnalyticSurface& surface, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& size = surface.size;
  switch (surface.kind) {
    case AnalyticSurface::Kind::kSphere:
      return chord_of_ball(origin, direction, size[0]);
    case AnalyticSurface::Kind::kCapsule:
      return chord_of_capsule(origin, direction, size[0], size[1]);
    case AnalyticSurface::Kind::kEllipsoid:
      return chord_of_ellipsoid(origin, direction, size);
    case AnalyticSurface::Kind::kCylinder:
      return chord_of_cylinder(origin, direction, size[0], size[1]);
    case AnalyticSurface::Kind::kPlane:
      break;  // no solid
  }
  return {};
}

bool within(double coordinate, double half_size) { return half_size <= 0.0 || std::abs(coordinate) <= half_size; }

std::optional<double> plane_range(const Eigen::Vector3d& size, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  if (direction.z() >= 0.0) return std::nullopt;
  const double range = -origin.z() / direction.z();
  const Eigen::Vector3d point = origin + range * direction;
  if (!std::isfinite(range) || !within(point.x(), size[0]) || !within(point.y(), size[1])) return std::nullopt;
  return range;
}

std::optional<double> range_in_geom(const AnalyticSurface& surface, const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction, double min_range_m) {
  if (surface.kind == AnalyticSurface::Kind::kPlane) {
    const std::optional<double> range = plane_range(surface.size, origin, direction);
    return range && *range >= min_range_m ? range : std::nullopt;
  }
  const Chord chord = chord_of_solid(surface, origin, direction);
  if (chord.enter > chord.leave || chord.leave < min_range_m) return std::nullopt;
  return chord.enter >= min_range_m ? chord.enter : chord.leave;
}

Eigen::Vector3d cylinder_normal(const Eigen::Vector3d& point, double radius, double half_length) {
  const double off_cap = std::abs(std::abs(point.z()) - half_length);
  const double off_side = std::abs(point.head<2>().norm() - radius);
  if (off_cap < off_side) return {0.0, 0.0, std::copysign(1.0, point.z())};
  return {point.x(), point.y(), 0.0};
}

// Outward at a point of the surface, of any length.
Eigen::Vector3d normal_in_geom(const AnalyticSurface& surface, const Eigen::Vector3d& point) {
  const Eigen::Vector3d& size = surface.size;
  switch (surface.kind) {
    case AnalyticSurface::Kind::kPlane:
      return Eigen::Vector3d::UnitZ();
    case AnalyticSurface::Kind::kSphere:
      return point;
    case AnalyticSurface::Kind::kCapsule:
      return point - std::clamp(point.z(), -size[1], size[1]) * Eigen::Vector3d::UnitZ();
    case AnalyticSurface::Kind::kEllipsoid:
      return point.cwiseQuotient(size.cwiseAbs2());
    case AnalyticSurface::Kind::kCylinder:
      return cylinder_normal(point, size[0], size[1]);
  }
  return Eigen::Vector3d::UnitZ();
}

double distance_to_plane(const Eigen::Vector3d& size, const Eigen::Vector3d& point) {
  const auto beyond = [](double coordinate, double half) {
    return half <= 0.0 ? 0.0 : std::max(0.0, std::abs(coordinate) - half);
  };
  return Eigen::Vector3d(beyond(point.x(), size[0]), beyond(point.y(), size[1]), point.z()).norm();
}

double distance_to_cylinder(const Eigen::Vector3d& point, double radius, double half_length) {
  const Eigen::Vector2d outside(point.head<2>().norm() - radius, std::abs(point.z()) - half_length);
  const double largest = outside.maxCoeff();
  return largest <= 0.0 ? -largest : outside.cwiseMax(0.0).norm();
}

// Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013), section 3: the nearest point
// is x_i = a_i^2 y_i / (t + a_i^2) at the largest root t of sum (a_i y_i / (t + a_i^2))^2 = 1; here s = t + min a_i^2,
// which keeps its digits when the root is close to the pole.
double distance_to_ellipsoid(const Eigen::Vector3d& semi_axes, const Eigen::Vector3d& point) {
  const Eigen::Array3d axes = semi_axes.array();
  // Off the symmetry planes by a hair, where the root would be the pole itself.
  const Eigen::Array3d y = point.array().abs().max(1e-12 * axes);
  const Eigen::Array3d squares = axes.square();
  const Eigen::Array3d above_least = squares - squares.minCoeff();
  double low = 0.0;
  double high = (axes * y).matrix().norm();
  for (double s = 0.5 * high; low < s && s < high; s = 0.5 * (low + high)) {
    const bool beyond_root = (axes * y / (above_least + s)).matrix().squaredNorm() < 1.0;
    (beyond_root ? high : low) = s;
  }
  const Eigen::Array3d nearest = squares * y / (above_least + high);
  return (nearest - y).matrix().norm();
}

}  // namespace

bool is_bounded(const AnalyticSurface& surface) {
  return surface.kind != AnalyticSurface::Kind::kPlane || (surface.size[0] > 0.0 && surface.size[1] > 0.0);
}

Eigen::AlignedBox3d bounds_in_world(const AnalyticSurface& surface) {
  const Eigen::Matrix3d& rotation = surface.world_from_geom_rotation;
  const Eigen::Vector3d& size = surface.size;
  const Eigen::Array3d axis = rotation.col(2).array().abs();
  Eigen::Array3d half = Eigen::Array3d::Zero();
  switch (surface.kind) {
    case AnalyticSurface::Kind::kPlane:
      half = rotation.leftCols<2>().cwiseAbs() * size.head<2>();
      break;
    case AnalyticSurface::Kind::kSphere:
      half = size[0];
      break;
    case AnalyticSurface::Kind::kCapsule:
      half = axis * size[1] + size[0];
      break;
    case AnalyticSurface::Kind::kEllipsoid:
      half = (rotation * size.asDiagonal()).rowwise().norm();
      break;
    case AnalyticSurface::Kind::kCylinder:
      half = axis * size[1] + (1.0 - axis.square()).max(0.0).sqrt() * size[0];
      break;
  }
  return {surface.position_in_world - half.matrix(), surface.position_in_world + half.matrix()};
}

std::optional<SurfaceHit> intersect(const AnalyticSurface& surface, const Eigen::Vector3d& origin_in_world,
                                    const Eigen::Vector3d& direction_in_world, double min_range_m, double max_range_m) {
  const Eigen::Matrix3d& rotation = surface.world_from_geom_rotation;
  const Eigen::Vector3d origin = rotation.transpose() * (origin_in_world - surface.position_in_world);
  const Eigen::Vector3d direction = rotation.transpose() * direction_in_world;
  const std::optional<double> range = range_in_geom(surface, origin, direction, min_range_m);
  if (!range || *range > max_range_m) return std::nullopt;
  const Eigen::Vector3d normal = normal_in_geom(surface, origin + *range * direction);
  return SurfaceHit{*range, rotation * normal.normalized()};
}

double distance(const AnalyticSurface& surface, const Eigen::Vector3d& point_in_world) {
  const Eigen::Vector3d point =
      surface.world_from_geom_rotation.transpose() * (point_in_world - surface.position_in_world);
  const Eigen::Vector3d& size = surface.size;
  switch (surface.kind) {
    case AnalyticSurface::Kind::kPlane:
      return distance_to_plane(size, point);
    case AnalyticSurface::Kind::kSphere:
      return std::abs(point.norm() - size[0]);
    case AnalyticSurface::Kind::kCapsule:
      return std::abs((point - std::clamp(point.z(), -size[1], size[1]) * Eigen::Vector3d::UnitZ()).norm() - size[0]);
    case AnalyticSurface::Kind::kEllipsoid:
      return distance_to_ellipsoid(size, point);
    case AnalyticSurface::Kind::kCylinder:
      return distance_to_cylinder(point, size[0], size[1]);
  }
  return kInfinity;
}

}  // namespace plumbline
