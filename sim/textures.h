#pragma once

#include <cstdint>
#include <vector>

#include "sim/world.h"

namespace plumbline {

/// A mip-mapped texture that tiles. A texel is a factor on the material's albedo, within 1 +- kTextureRange; the mean
/// over the tile is 1.
struct Texture {
  int size = 0;                            ///< of level 0, a power of two
  std::vector<std::vector<float>> levels;  ///< box-filtered in linear light, down to one texel
};

inline constexpr float kTextureRange = 0.9F;
inline constexpr int kTextureSize = 1024;

/// Every surface is the product of two textures whose periods do not fit together, so that no place looks like another:
/// the structure (courses, seams, lettering), upright, and the wear (stains, chips, cracks), turned by kWearAngle.
inline constexpr double kStructurePeriod_m = 5.12;
inline constexpr double kWearPeriod_m = 8.37;
inline constexpr double kWearAngle_rad = 0.63;

struct SurfaceTextures {
  Texture structure;
  Texture wear;
};

/// The same seed, pattern and name give the same bytes. Both textures of kPlain are a faint, smooth variation without
/// corners. Texture rows run down walls.
SurfaceTextures make_textures(const Material& material, std::uint64_t world_seed);

/// Textures for many materials, on all cores.
std::vector<SurfaceTextures> make_textures(const std::vector<Material>& materials, std::uint64_t world_seed);

}  // namespace plumbline
