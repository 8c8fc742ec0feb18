#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace plumbline {

/// Scenery of one material as triangles, counter-clockwise seen from outside. Scenes of thousands of parts hand over a
/// few meshes, each within some 60 m, in place of as many geoms. Meshes may be open or flat, and parts may cross.
struct SceneMesh {
  std::string name;  ///< unique in the scene
  std::string material;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< world; keeps the vertices precise far away
  std::vector<Eigen::Vector3f> vertices;             ///< relative to origin, axes of the world [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A corner of scenery, rounded to 2^-14 m in the world: corners that meet stay together in meshes of different
/// origins.
Eigen::Vector3d on_grid(const Eigen::Vector3d& corner_in_world);

/// The same triangles in at most `limit` meshes, or one for each material if that is more: neighbours in the list that
/// share a material are put together.
std::vector<SceneMesh> joined_meshes(std::vector<SceneMesh> meshes, std::size_t limit);

/// @throws std::invalid_argument naming the mesh that is empty, not finite, refers to a vertex it does not have, or has
/// the name of another one.
void check_meshes(const std::vector<SceneMesh>& meshes);

}  // namespace plumbline
