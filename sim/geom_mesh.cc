#include "sim/geom_mesh.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

using Index = std::uint32_t;

void add_quad(TriangleMesh& mesh, Index a, Index b, Index c, Index d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

Eigen::Vector3d size_of(const mjModel& model, int geom) {
  return Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3L * geom);
}

// A size of 0 makes a MuJoCo plane infinite along that axis.
TriangleMesh plane_mesh(const Eigen::Vector3d& size, double extent_m) {
  const auto x = static_cast<float>(size.x() > 0.0 ? size.x() : extent_m);
  const auto y = static_cast<float>(size.y() > 0.0 ? size.y() : extent_m);
  return {{{-x, -y, 0.0F}, {x, -y, 0.0F}, {x, y, 0.0F}, {-x, y, 0.0F}}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh box_mesh(const Eigen::Vector3d& half_size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                               (corner & 4) != 0 ? 1.0 : -1.0);
    mesh.vertices.emplace_back(half_size.cwiseProduct(sign).cast<float>());
  }
  add_quad(mesh, 0, 2, 3, 1);  // -z
  add_quad(mesh, 4, 5, 7, 6);  // +z
  add_quad(mesh, 0, 1, 5, 4);  // -y
  add_quad(mesh, 2, 6, 7, 3);  // +y
  add_quad(mesh, 0, 4, 6, 2);  // -x
  add_quad(mesh, 1, 3, 7, 5);  // +x
  return mesh;
}

// A point of the half-plane that is turned about z; the profile leads from the lower to the upper pole.
struct ProfilePoint {
  double radius = 0.0;
  double z = 0.0;
};

TriangleMesh revolve(double bottom_z, const std::vector<ProfilePoint>& rings, double top_z, int segments) {
  TriangleMesh mesh;
  for (const ProfilePoint& ring : rings) {
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / segments;
      mesh.vertices.emplace_back(
          Eigen::Vector3d(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z).cast<float>());
    }
  }
  const auto bottom = static_cast<Index>(mesh.vertices.size());
  const Index top = bottom + 1;
  mesh.vertices.emplace_back(0.0F, 0.0F, static_cast<float>(bottom_z));
  mesh.vertices.emplace_back(0.0F, 0.0F, static_cast<float>(top_z));

  const auto count = static_cast<Index>(segments);
  const Index last_ring = bottom - count;
  for (Index s = 0; s < count; ++s) {
    const Index next = (s + 1) % count;
    mesh.triangles.push_back({bottom, next, s});
    for (Index ring = 0; ring < last_ring; ring += count) {
      add_quad(mesh, ring + s, ring + next, ring + count + next, ring + count + s);
    }
    mesh.triangles.push_back({top, last_ring + s, last_ring + next});
  }
  return mesh;
}

int segments_for(double step) { return std::max(8, static_cast<int>(std::ceil(2.0 * std::numbers::pi / step))); }

// A chord over `step` radians lies radius (1 - cos(step / 2)) inside its circle.
int circle_segments(double radius, double tolerance_m) {
  const double cosine = std::max(0.0, 1.0 - tolerance_m / radius);
  return segments_for(2.0 * std::acos(cosine));
}

// A right triangle with legs of `step` radians has a circumradius of step / sqrt(2), where it is deepest in the sphere.
int sphere_segments(double radius, double tolerance_m) {
  const double cosine = std::max(0.0, 1.0 - tolerance_m / radius);
  const int segments = segments_for(std::numbers::sqrt2 * std::acos(cosine));
  return segments + segments % 2;
}

// Latitudes of the lower (sign -1) or upper half of a sphere about height z, from below; poles excluded, equator
// included.
void add_hemisphere(std::vector<ProfilePoint>& rings, double radius, double z, int segments, int sign) {
  const int quarter = (segments + 3) / 4;
  for (int i = 1; i <= quarter; ++i) {
    const int step = sign < 0 ? i : quarter + 1 - i;
    const double angle_from_pole = 0.5 * std::numbers::pi * step / quarter;
    rings.push_back({radius * std::sin(angle_from_pole), z + sign * radius * std::cos(angle_from_pole)});
  }
}

TriangleMesh ellipsoid_mesh(const Eigen::Vector3d& semi_axes, double tolerance_m) {
  // On the unit sphere, stretched afterwards: the deviation grows with the longest axis at most.
  const int segments = sphere_segments(semi_axes.maxCoeff(), tolerance_m);
  std::vector<ProfilePoint> rings;
  add_hemisphere(rings, 1.0, 0.0, segments, -1);
  rings.pop_back();  // the upper half brings the equator
  add_hemisphere(rings, 1.0, 0.0, segments, 1);
  TriangleMesh mesh = revolve(-1.0, rings, 1.0, segments);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(semi_axes.cast<float>());
  return mesh;
}

TriangleMesh capsule_mesh(double radius, double half_length, double tolerance_m) {
  const int segments = sphere_segments(radius, tolerance_m);
  std::vector<ProfilePoint> rings;
  add_hemisphere(rings, radius, -half_length, segments, -1);
  add_hemisphere(rings, radius, half_length, segments, 1);
  return revolve(-half_length - radius, rings, half_length + radius, segments);
}

TriangleMesh cylinder_mesh(double radius, double half_length, double tolerance_m) {
  return revolve(-half_length, {{radius, -half_length}, {radius, half_length}}, half_length,
                 circle_segments(radius, tolerance_m));
}

TriangleMesh compiled_mesh(const mjModel& model, int mesh_id) {
  TriangleMesh mesh;
  const float* vertex = model.mesh_vert + 3L * model.mesh_vertadr[mesh_id];
  for (int i = 0; i < model.mesh_vertnum[mesh_id]; ++i, vertex += 3) {
    mesh.vertices.emplace_back(vertex[0], vertex[1], vertex[2]);
  }
  const int* face = model.mesh_face + 3L * model.mesh_faceadr[mesh_id];
  for (int i = 0; i < model.mesh_facenum[mesh_id]; ++i, face += 3) {
    mesh.triangles.push_back({static_cast<Index>(face[0]), static_cast<Index>(face[1]), static_cast<Index>(face[2])});
  }
  return mesh;
}

// Grid vertices around the rim, counter-clockwise seen from above.
std::vector<Index> rim_of_grid(Index rows, Index columns) {
  std::vector<Index> rim;
  for (Index c = 0; c + 1 < columns; ++c) rim.push_back(c);
  for (Index r = 0; r + 1 < rows; ++r) rim.push_back(r * columns + columns - 1);
  for (Index c = columns - 1; c > 0; --c) rim.push_back((rows - 1) * columns + c);
  for (Index r = rows - 1; r > 0; --r) rim.push_back(r * columns);
  return rim;
}

// The skirt from the rim down to the base, and the base itself as a fan, so that every edge is shared by two triangles.
void add_base(TriangleMesh& mesh, const std::vector<Index>& rim, float base_z) {
  const auto first_below = static_cast<Index>(mesh.vertices.size());
  for (const Index i : rim) mesh.vertices.emplace_back(mesh.vertices[i].x(), mesh.vertices[i].y(), base_z);
  const auto centre = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0F, 0.0F, base_z);
  const auto count = static_cast<Index>(rim.size());
  for (Index i = 0; i < count; ++i) {
    const Index next = (i + 1) % count;
    add_quad(mesh, first_below + i, first_below + next, rim[next], rim[i]);
    mesh.triangles.push_back({centre, first_below + next, first_below + i});
  }
}

// As mj_ray sees it: each cell split along the diagonal of growing row and column, solid down to the base.
TriangleMesh height_field_mesh(const mjModel& model, int field) {
  const auto rows = static_cast<Index>(model.hfield_nrow[field]);
  const auto columns = static_cast<Index>(model.hfield_ncol[field]);
  const mjtNum* size = model.hfield_size + 4L * field;  // half x, half y, height of 1, depth of the base
  const float* heights = model.hfield_data + model.hfield_adr[field];
  TriangleMesh mesh;
  for (Index r = 0; r < rows; ++r) {
    for (Index c = 0; c < columns; ++c) {
      const double x = size[0] * (2.0 * c / (columns - 1) - 1.0);
      const double y = size[1] * (2.0 * r / (rows - 1) - 1.0);
      mesh.vertices.emplace_back(Eigen::Vector3d(x, y, heights[r * columns + c] * size[2]).cast<float>());
    }
  }
  for (Index r = 0; r + 1 < rows; ++r) {
    for (Index c = 0; c + 1 < columns; ++c) {
      const Index corner = r * columns + c;
      add_quad(mesh, corner, corner + 1, corner + columns + 1, corner + columns);
    }
  }
  add_base(mesh, rim_of_grid(rows, columns), static_cast<float>(-size[3]));
  return mesh;
}

}  // namespace

TriangleMesh mesh_of_geom(const mjModel& model, int geom, double tolerance_m, double plane_extent_m) {
  if (!(tolerance_m > 0.0)) {
    throw std::invalid_argument("mesh_of_geom: tolerance_m is " + std::to_string(tolerance_m) + ", must be positive");
  }
  const Eigen::Vector3d size = size_of(model, geom);
  switch (model.geom_type[geom]) {
    case mjGEOM_PLANE:
      return plane_mesh(size, plane_extent_m);
    case mjGEOM_HFIELD:
      return height_field_mesh(model, model.geom_dataid[geom]);
    case mjGEOM_SPHERE:
      return ellipsoid_mesh(Eigen::Vector3d::Constant(size[0]), tolerance_m);
    case mjGEOM_CAPSULE:
      return capsule_mesh(size[0], size[1], tolerance_m);
    case mjGEOM_ELLIPSOID:
      return ellipsoid_mesh(size, tolerance_m);
    case mjGEOM_CYLINDER:
      return cylinder_mesh(size[0], size[1], tolerance_m);
    case mjGEOM_BOX:
      return box_mesh(size);
    case mjGEOM_MESH:
      return compiled_mesh(model, model.geom_dataid[geom]);
    default:
      throw std::invalid_argument("mesh_of_geom: geom " + std::to_string(geom) + " is of type " +
                                  std::to_string(model.geom_type[geom]) + ", which has no surface");
  }
}

}  // namespace plumbline
