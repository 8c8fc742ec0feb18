#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/light_map.h"
#include "sim/world.h"

namespace plumbline {

/// A corner of a drawn triangle; the renderer's shaders read it in this order.
struct RenderVertex {
  static constexpr std::array<int, 6> kAttributeSizes = {3, 4, 2, 4, 3, 3};

  std::array<float, 3> position;  ///< relative to the chunk's origin [m]
  std::array<float, 4> place;     ///< on the structure's and the wear's texture [tiles]
  std::array<float, 2> light;     ///< on the light map [texels]
  std::array<float, 4> surface;   ///< albedo / pi, contrast, texture layer, illuminance by sun and sky [lux]
  std::array<float, 3> normal;    ///< unit, outward
  std::array<float, 3> tint;      ///< linear red, green, blue; of luminance 1

  bool operator==(const RenderVertex&) const = default;
};

/// What lies in one cube of the world, drawn at once: culled by its bounds, precise about its own origin.
struct RenderChunk {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d bounds;
  bool lit_by_lamps = false;  ///< otherwise its place on the light map means nothing
  bool two_sided = false;
  std::vector<RenderVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// A square of the world's plan, from the deepest to the highest.
struct RenderTile {
  std::vector<RenderChunk> chunks;
  LightMap light_map;  ///< empty where no lamp reaches
};

/// Cuts the surfaces of some geoms within a box of the world along a grid of cubes; where no lamp reaches, the cubes
/// are larger. Neighbouring boxes fit together.
/// @param layer_of_material  texture layer, for each of world.materials()
RenderTile make_render_tile(const World& world, const std::vector<int>& geoms, const Eigen::AlignedBox2d& plan,
                            const std::vector<int>& layer_of_material);

/// The surfaces of a moving thing in one or two chunks: its geoms as they stand, in a frame given by its pose.
std::vector<RenderChunk> make_body_chunks(const World& world, const std::vector<int>& geoms,
                                          const Pose& world_from_body, const std::vector<int>& layer_of_material);

/// As mj_ray sees it: a geom whose material, or colour where it has none, is fully transparent is not there.
bool is_drawn(const World& world, int geom);

}  // namespace plumbline
