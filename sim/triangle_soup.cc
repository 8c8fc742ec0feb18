#include "sim/triangle_soup.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace plumbline {
namespace {

double distance_to_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = b - a;
  const double length_squared = along.squaredNorm();
  const double ratio = length_squared > 0.0 ? std::clamp((point - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return (point - a - ratio * along).norm();
}

}  // namespace

void TriangleSoup::append(const TriangleMesh& mesh, const Eigen::Matrix3d& world_from_geom_rotation,
                          const Eigen::Vector3d& position_in_world, int geom) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    vertices_.emplace_back(world_from_geom_rotation * vertex.cast<double>() + position_in_world);
  }
  for (const Triangle& t : mesh.triangles) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
  geom_of_triangle_.insert(geom_of_triangle_.end(), mesh.triangles.size(), geom);
}

std::array<Eigen::Vector3d, 3> TriangleSoup::corners(std::uint32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
}

double TriangleSoup::refined_range(std::uint32_t triangle, const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& direction, double estimate_m) const {
  const auto [a, b, c] = corners(triangle);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double closing = normal.dot(direction);
  if (closing == 0.0) return estimate_m;
  // A plane seen edge-on answers far off for an error in the last digit: the triangle's own extent bounds it.
  const auto [nearest, farthest] =
      std::minmax({(a - origin).dot(direction), (b - origin).dot(direction), (c - origin).dot(direction)});
  return std::clamp(normal.dot(a - origin) / closing, nearest, farthest);
}

Eigen::Vector3d TriangleSoup::unit_normal(std::uint32_t triangle) const {
  const auto [a, b, c] = corners(triangle);
  return (b - a).cross(c - a).normalized();
}

double TriangleSoup::distance(std::uint32_t triangle, const Eigen::Vector3d& point) const {
  const auto [a, b, c] = corners(triangle);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const bool over_face = normal.dot((b - a).cross(point - a)) >= 0.0 && normal.dot((c - b).cross(point - b)) >= 0.0 &&
                         normal.dot((a - c).cross(point - c)) >= 0.0;
  if (over_face && normal.squaredNorm() > 0.0) return std::abs(normal.dot(point - a)) / normal.norm();
  return std::min(
      {distance_to_segment(a, b, point), distance_to_segment(b, c, point), distance_to_segment(c, a, point)});
}

}  // namespace plumbline
