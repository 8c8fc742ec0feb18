#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/light_map.h"
#include "sim/world.h"

namespace plumbline {

/// A corner of a drawn triangle; the renderer's shader reads it in this order.
struct RenderVertex {
  static constexpr std::array<int, 4> kAttributeSizes = {3, 4, 2, 3};

  std::array<float, 3> position;  ///< relative to the chunk's origin [m]
  std::array<float, 4> place;     ///< on the structure's and the wear's texture [tiles]
  std::array<float, 2> light;     ///< on the light map [texels]
  std::array<float, 3> surface;   ///< albedo / pi, contrast, texture layer

  bool operator==(const RenderVertex&) const = default;
};

/// What lies in one cube of the world, drawn at once: culled by its bounds, precise about its own origin.
struct RenderChunk {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d bounds;
  std::vector<RenderVertex> vertices;
  std::vector<std::uint32_t> indices;
};

struct RenderScene {
  std::vector<RenderChunk> chunks;
  LightMap light_map;
};

/// Cuts the surfaces of all visible geoms, where they stand now, along a grid of cubes. Where no lamp reaches, the
/// cubes are larger. An infinite plane ends view_distance_m beyond everything else.
/// @param layer_of_material  texture layer, for each of world.materials()
RenderScene make_render_scene(const World& world, const std::vector<int>& layer_of_material, double view_distance_m);

}  // namespace plumbline
