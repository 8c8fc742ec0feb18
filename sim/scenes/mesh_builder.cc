#include "sim/scenes/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumbline {
namespace {

std::vector<Eigen::Vector3d> ring(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& axis,
                                  int sides) {
  const Eigen::Vector3d right = axis.unitOrthogonal();
  const Eigen::Vector3d ahead = axis.cross(right);
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    corners.emplace_back(centre + radius * (std::cos(angle) * right + std::sin(angle) * ahead));
  }
  return corners;
}

int cells(double length, double step) { return std::max(1, static_cast<int>(std::ceil(length / step - 1e-9))); }

}  // namespace

void MeshBuilder::add_fan(const std::string& material, const std::vector<Eigen::Vector3d>& corners_in_world) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners_in_world) {
    centre += corner / static_cast<double>(corners_in_world.size());
  }
  const int x = static_cast<int>(std::floor(centre.x() / kTile_m));
  const int y = static_cast<int>(std::floor(centre.y() / kTile_m));
  const auto [entry, is_new] = meshes_.try_emplace({material, x, y});
  SceneMesh& mesh = entry->second;
  if (is_new) {
    mesh.name = material + " " + std::to_string(x) + " " + std::to_string(y);
    mesh.material = material;
    mesh.origin = {kTile_m * x, kTile_m * y, 0.0};
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& corner : corners_in_world) {
    mesh.vertices.emplace_back((on_grid(corner) - mesh.origin).cast<float>());
  }
  for (std::uint32_t i = 2; i < corners_in_world.size(); ++i) {
    mesh.triangles.push_back({first, first + i - 1, first + i});
    ++triangle_count_;
  }
}

void MeshBuilder::polygon(const std::string& material, const std::vector<Eigen::Vector3d>& corners,
                          const Pose& world_from_local) {
  std::vector<Eigen::Vector3d> in_world;
  for (const Eigen::Vector3d& corner : corners) in_world.push_back(world_from_local * corner);
  add_fan(material, in_world);
}

void MeshBuilder::triangle(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c, const Pose& world_from_local) {
  polygon(material, {a, b, c}, world_from_local);
}

void MeshBuilder::quad(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c, const Eigen::Vector3d& d, const Pose& world_from_local) {
  polygon(material, {a, b, c, d}, world_from_local);
}

void MeshBuilder::box(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                      const Pose& world_from_local) {
  const auto corner = [&](int x, int y, int z) {
    return Eigen::Vector3d((x != 0 ? high : low).x(), (y != 0 ? high : low).y(), (z != 0 ? high : low).z());
  };
  const auto face = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& d) { quad(material, a, b, c, d, world_from_local); };
  face(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
  face(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
  face(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
  face(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
  face(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
  face(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
}

void MeshBuilder::prism(const std::string& walls, const std::string& top, const std::vector<Eigen::Vector2d>& footprint,
                        double low_z, double high_z, const Pose& world_from_local) {
  std::vector<Eigen::Vector3d> roof;
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2d& a = footprint[i];
    const Eigen::Vector2d& b = footprint[(i + 1) % footprint.size()];
    quad(walls, {a.x(), a.y(), low_z}, {b.x(), b.y(), low_z}, {b.x(), b.y(), high_z}, {a.x(), a.y(), high_z},
         world_from_local);
    roof.emplace_back(a.x(), a.y(), high_z);
  }
  polygon(top, roof, world_from_local);
}

void MeshBuilder::frustum(const std::string& material, const Eigen::Vector3d& from, double from_radius_m,
                          const Eigen::Vector3d& to, double to_radius_m, int sides, const Pose& world_from_local) {
  const Eigen::Vector3d axis = (to - from).normalized();
  std::vector<Eigen::Vector3d> lower = ring(from, from_radius_m, axis, sides);
  const std::vector<Eigen::Vector3d> upper = ring(to, to_radius_m, axis, sides);
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const std::size_t next = (i + 1) % lower.size();
    if (to_radius_m == 0.0) {
      triangle(material, lower[i], lower[next], to, world_from_local);
    } else if (from_radius_m == 0.0) {
      triangle(material, from, upper[next], upper[i], world_from_local);
    } else {
      quad(material, lower[i], lower[next], upper[next], upper[i], world_from_local);
    }
  }
  if (to_radius_m > 0.0) polygon(material, upper, world_from_local);
  if (from_radius_m > 0.0) polygon(material, {lower.rbegin(), lower.rend()}, world_from_local);
}

void MeshBuilder::cylinder(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           double radius_m, int sides, const Pose& world_from_local) {
  frustum(material, from, radius_m, to, radius_m, sides, world_from_local);
}

void MeshBuilder::terrain(const std::string& material, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                          double step_m, const std::function<double(double, double)>& height) {
  const int columns = cells(high.x() - low.x(), step_m);
  const int rows = cells(high.y() - low.y(), step_m);
  const auto point = [&](int column, int row) {
    const double x = low.x() + (high.x() - low.x()) * column / columns;
    const double y = low.y() + (high.y() - low.y()) * row / rows;
    return Eigen::Vector3d(x, y, height(x, y));
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      quad(material, point(column, row), point(column + 1, row), point(column + 1, row + 1), point(column, row + 1));
    }
  }
}

std::vector<SceneMesh> MeshBuilder::take() {
  std::vector<SceneMesh> meshes;
  for (auto& [key, mesh] : meshes_) meshes.push_back(std::move(mesh));
  meshes_.clear();
  triangle_count_ = 0;
  return meshes;
}

}  // namespace plumbline
