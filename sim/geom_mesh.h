#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

struct mjModel_;

namespace plumbline {

/// Triangles with outward normals by their winding (counter-clockwise seen from outside), in the geom's own frame.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The surface of one geom of the compiled model, in the geom's frame (mjData::geom_xpos, geom_xmat). Boxes, meshes and
/// height fields exactly; curved types within `tolerance_m` of the true surface; an infinite plane as a square of
/// half-width `plane_extent_m`. Both the ray-casting and the rendered copy of the world come from here.
TriangleMesh mesh_of_geom(const mjModel_& model, int geom, double tolerance_m, double plane_extent_m);

}  // namespace plumbline
