#include "sim/scenes/scenery.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace plumbline {

using Eigen::Vector3d;

namespace {

void append(SceneMesh& mesh, const SceneMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f shift = (other.origin - mesh.origin).cast<float>();
  for (const Eigen::Vector3f& vertex : other.vertices) mesh.vertices.push_back(vertex + shift);
  for (const auto& t : other.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

SceneMesh& Scenery::batch(const std::string& material, const Vector3d& place) {
  const auto id = material_ids_.try_emplace(material, static_cast<int>(material_ids_.size())).first->second;
  const auto column = static_cast<int>(std::floor(place.x() / tile_m_));
  const auto row = static_cast<int>(std::floor(place.y() / tile_m_));
  const auto [entry, is_new] = batches_.try_emplace({id, column, row});
  if (is_new) {
    SceneMesh& mesh = entry->second;
    mesh.name = material + "/" + std::to_string(column) + "/" + std::to_string(row);
    mesh.material = material;
    mesh.origin = {(column + 0.5) * tile_m_, (row + 0.5) * tile_m_, std::round(place.z())};
  }
  return entry->second;
}

void Scenery::add(SceneMesh& mesh, std::initializer_list<Vector3d> corners,
                  std::initializer_list<std::array<std::uint32_t, 3>> triangles) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3d& corner : corners) mesh.vertices.emplace_back((on_grid(corner) - mesh.origin).cast<float>());
  for (const auto& t : triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  triangle_count_ += triangles.size();
}

void Scenery::triangle(const std::string& material, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  add(batch(material, a), {a, b, c}, {{0, 1, 2}});
}

void Scenery::quad(const std::string& material, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                   const Vector3d& d) {
  add(batch(material, a), {a, b, c, d}, {{0, 1, 2}, {0, 2, 3}});
}

void Scenery::sheet(const std::string& material, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                    const Vector3d& d) {
  add(batch(material, a), {a, b, c, d}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}});
}

void Scenery::box_sides(const std::string& material, const Vector3d& low, const Vector3d& high,
                        const Pose& world_from_local, bool with_bottom) {
  const auto corner = [&](double x, double y, double z) { return world_from_local * Vector3d(x, y, z); };
  SceneMesh& mesh = batch(material, corner(low.x(), low.y(), low.z()));
  add(mesh,
      {corner(low.x(), low.y(), low.z()), corner(high.x(), low.y(), low.z()), corner(high.x(), high.y(), low.z()),
       corner(low.x(), high.y(), low.z()), corner(low.x(), low.y(), high.z()), corner(high.x(), low.y(), high.z()),
       corner(high.x(), high.y(), high.z()), corner(low.x(), high.y(), high.z())},
      {{4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}});
  if (!with_bottom) return;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size() - 8);
  mesh.triangles.push_back({first, first + 2, first + 1});
  mesh.triangles.push_back({first, first + 3, first + 2});
  triangle_count_ += 2;
}

void Scenery::box(const std::string& material, const Vector3d& low, const Vector3d& high,
                  const Pose& world_from_local) {
  box_sides(material, low, high, world_from_local, true);
}

void Scenery::block(const std::string& material, const Vector3d& low, const Vector3d& high,
                    const Pose& world_from_local) {
  box_sides(material, low, high, world_from_local, false);
}

void Scenery::rod(const std::string& material, const Vector3d& from, const Vector3d& to, double from_radius_m,
                  double to_radius_m, int sides) {
  const Vector3d axis = (to - from).normalized();
  const Vector3d u = axis.unitOrthogonal();
  const Vector3d v = axis.cross(u);
  SceneMesh& mesh = batch(material, from);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
    mesh.vertices.emplace_back((on_grid(from + from_radius_m * out) - mesh.origin).cast<float>());
    mesh.vertices.emplace_back((on_grid(to + to_radius_m * out) - mesh.origin).cast<float>());
  }
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = first + 2U * static_cast<std::uint32_t>(i);
    const std::uint32_t b = first + 2U * static_cast<std::uint32_t>((i + 1) % sides);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  triangle_count_ += 2 * static_cast<std::size_t>(sides);
}

void Scenery::prism(const std::string& material, const std::vector<Eigen::Vector2d>& profile, double y0, double y1,
                    const Pose& world_from_local) {
  SceneMesh& mesh = batch(material, world_from_local.translation);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double y : {y0, y1}) {
    for (const Eigen::Vector2d& p : profile) {
      const Vector3d corner = world_from_local * Vector3d(p.x(), y, p.y());
      mesh.vertices.emplace_back((on_grid(corner) - mesh.origin).cast<float>());
    }
  }
  const auto count = static_cast<std::uint32_t>(profile.size());
  for (std::uint32_t i = 2; i < count; ++i) {
    mesh.triangles.push_back({first, first + i - 1, first + i});
    mesh.triangles.push_back({first + count, first + count + i, first + count + i - 1});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = first + (i + 1) % count;
    mesh.triangles.push_back({a, a + count, b + count});
    mesh.triangles.push_back({a, b + count, b});
  }
  triangle_count_ += 2 * (count - 2) + 2 * count;
}

std::vector<SceneMesh> Scenery::take_meshes() {
  constexpr std::size_t kRare = 600;  // triangles on a group of tiles
  std::map<Key, std::vector<SceneMesh*>> groups;
  for (auto& [key, mesh] : batches_) {
    const auto& [material, column, row] = key;
    groups[{material, column >> 2, row >> 2}].push_back(&mesh);
  }
  std::vector<SceneMesh> meshes;
  for (auto& [key, group] : groups) {
    std::size_t triangles = 0;
    for (const SceneMesh* mesh : group) triangles += mesh->triangles.size();
    for (SceneMesh* mesh : group) {
      if (mesh == group.front() || triangles > kRare) {
        meshes.push_back(std::move(*mesh));
      } else {
        append(meshes.back(), *mesh);
      }
    }
  }
  batches_.clear();
  material_ids_.clear();
  triangle_count_ = 0;
  return meshes;
}

}  // namespace plumbline
