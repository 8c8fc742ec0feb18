#include "sim/scene_mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace plumbline {
namespace {

void append(SceneMesh& mesh, const SceneMesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3d shift = more.origin - mesh.origin;
  for (const Eigen::Vector3f& vertex : more.vertices) {
    mesh.vertices.emplace_back((vertex.cast<double>() + shift).cast<float>());
  }
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

void check(const SceneMesh& mesh) {
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument("mesh '" + mesh.name + "': " + rule);
  };
  require(!mesh.triangles.empty(), "must have triangles");
  require(mesh.origin.allFinite(), "its origin must be finite");
  for (const Eigen::Vector3f& vertex : mesh.vertices) require(vertex.allFinite(), "its vertices must be finite");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      require(corner < mesh.vertices.size(), "its triangles must refer to its own vertices");
    }
  }
}

}  // namespace

Eigen::Vector3d on_grid(const Eigen::Vector3d& corner_in_world) {
  constexpr double kGrid_m = 1.0 / 16384.0;
  return (corner_in_world / kGrid_m).array().round() * kGrid_m;
}

std::vector<SceneMesh> joined_meshes(std::vector<SceneMesh> meshes, std::size_t limit) {
  if (meshes.size() <= limit) return meshes;
  std::map<std::string, std::vector<SceneMesh>> of_material;
  const double share = static_cast<double>(limit) / static_cast<double>(meshes.size());
  for (SceneMesh& mesh : meshes) of_material[mesh.material].push_back(std::move(mesh));
  std::vector<SceneMesh> joined;
  for (auto& [material, parts] : of_material) {
    const auto allowed = std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(parts.size())));
    const std::size_t group = (parts.size() + allowed - 1) / allowed;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i % group == 0) {
        joined.push_back(std::move(parts[i]));
      } else {
        append(joined.back(), parts[i]);
      }
    }
  }
  return joined;
}

void check_meshes(const std::vector<SceneMesh>& meshes) {
  std::set<std::string> names;
  for (const SceneMesh& mesh : meshes) {
    check(mesh);
    if (!names.insert(mesh.name).second) throw std::invalid_argument("two meshes have the name '" + mesh.name + "'");
  }
}

}  // namespace plumbline
