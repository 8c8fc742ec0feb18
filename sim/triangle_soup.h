#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/geom_mesh.h"

namespace plumbline {

/// All triangles of a world in one list, in double precision: Embree finds the triangle in float, and what is reported
/// about it is computed here.
class TriangleSoup {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  void append(const TriangleMesh& mesh, const Eigen::Matrix3d& world_from_geom_rotation,
              const Eigen::Vector3d& position_in_world, int geom);

  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  int geom_of(std::uint32_t triangle) const { return geom_of_triangle_[triangle]; }

  /// Where a ray that is known to meet the triangle at about `estimate_m` meets its plane.
  double refined_range(std::uint32_t triangle, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       double estimate_m) const;
  /// By the winding.
  Eigen::Vector3d unit_normal(std::uint32_t triangle) const;
  double distance(std::uint32_t triangle, const Eigen::Vector3d& point) const;

 private:
  std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<int> geom_of_triangle_;
};

}  // namespace plumbline
