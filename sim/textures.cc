#include "sim/textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/random_stream.h"
#include "sim/tile_canvas.h"

namespace plumbline {
namespace {

constexpr float kTexelsPerMetre = static_cast<float>(kTextureSize / kStructurePeriod_m);

float draw(RandomStream& stream, double low, double high) { return static_cast<float>(stream.uniform(low, high)); }

Eigen::Vector2f draw_place(RandomStream& stream) {
  const float x = draw(stream, 0.0, kTextureSize);
  return {x, draw(stream, 0.0, kTextureSize)};
}

float draw_sign(RandomStream& stream) { return stream.uniform() < 0.5 ? -1.0F : 1.0F; }

std::string draw_letters(RandomStream& stream, int count) {
  static constexpr char kGlyphs[] = "ABCDEFGHKLMNPRSTUVXYZ2345679";
  std::string text;
  for (int i = 0; i < count; ++i) text += kGlyphs[stream.integer(0, static_cast<int>(sizeof(kGlyphs)) - 2)];
  return text;
}

/// Angular patches lighter and darker than their surroundings, as many square metres of each size: corners for every
/// distance. `cover` is the share of the surface that each octave of sizes covers.
void add_chips(TileCanvas& canvas, float smallest, float largest, float cover, float value, RandomStream& stream) {
  const auto area = static_cast<float>(canvas.size()) * static_cast<float>(canvas.size());
  for (float size = smallest; size <= largest; size *= 2.0F) {
    const int count = static_cast<int>(cover * area / (4.0F * size * size));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2f half_size(size * draw(stream, 0.6, 1.4), size * draw(stream, 0.6, 1.4));
      const Eigen::Vector2f place = draw_place(stream);
      const float angle = draw(stream, 0.0, 3.14159);
      canvas.add_box(place, half_size, angle, value * draw_sign(stream) * draw(stream, 0.5, 1.2));
    }
  }
}

void add_cracks(TileCanvas& canvas, int count, float value, RandomStream& stream) {
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2f start = draw_place(stream);
    const float length = draw(stream, 60.0, 400.0);
    canvas.add_crack(start, length, draw(stream, 1.2, 4.0), value, stream.bits());
  }
}

void draw_concrete(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(2, 8, 0.10F, 0.0F, stream.bits());
  canvas.add_octaves(16, 256, 0.11F, 0.7F, stream.bits());
  add_chips(canvas, 1.5F, 24.0F, 0.03F, 0.30F, stream);
  add_cracks(canvas, 25, -0.35F, stream);
  constexpr int kBoard = 256;  // formwork boards of 1.28 m with a seam and tie holes
  for (int y = 0; y < kTextureSize; y += kBoard / 2) {
    for (int x = 0; x < kTextureSize; x += kBoard) {
      const Eigen::Vector2f corner(static_cast<float>(x), static_cast<float>(y));
      const float tone = draw(stream, -0.12, 0.12);
      canvas.add_box(corner + Eigen::Vector2f(128.0F, 64.0F), {128.0F, 64.0F}, 0.0F, tone);
      canvas.add_box(corner + Eigen::Vector2f(128.0F, 0.0F), {128.0F, 1.2F}, 0.0F, -0.25F);
      canvas.add_box(corner + Eigen::Vector2f(0.0F, 64.0F), {1.2F, 64.0F}, 0.0F, -0.25F);
      canvas.add_disc(corner + Eigen::Vector2f(draw(stream, 40.0, 216.0), draw(stream, 24.0, 104.0)), 3.5F, -0.5F);
    }
  }
}

void draw_brick(TileCanvas& canvas, RandomStream& stream) {
  constexpr int kCourse = 16;       // 8 cm
  constexpr int kLength = 256 / 5;  // 20 bricks of 25.6 cm in the tile
  constexpr float kJoint = 2.0F;
  canvas.add_octaves(2, 8, 0.09F, 0.2F, stream.bits());
  canvas.add_octaves(64, 256, 0.09F, 0.6F, stream.bits());
  for (int course = 0; course * kCourse < kTextureSize; ++course) {
    const float shift = (course % 2) * 0.5F * kLength + draw(stream, -3.0, 3.0);
    const int bricks = kTextureSize / kLength;
    const float length = static_cast<float>(kTextureSize) / static_cast<float>(bricks);
    for (int brick = 0; brick < bricks; ++brick) {
      const Eigen::Vector2f centre(shift + (static_cast<float>(brick) + 0.5F) * length,
                                   (static_cast<float>(course) + 0.5F) * kCourse);
      const Eigen::Vector2f half_size(0.5F * length - kJoint, 0.5F * kCourse - 0.7F * kJoint);
      // Joints are lighter than most bricks; a few bricks are burnt or replaced.
      const float tone = draw(stream, -0.45, 0.05) + (stream.uniform() < 0.06 ? 0.5F * draw_sign(stream) : 0.0F);
      canvas.add_box(centre, half_size, 0.0F, tone);
    }
  }
  add_chips(canvas, 1.5F, 24.0F, 0.015F, 0.3F, stream);
}

void draw_panels(TileCanvas& canvas, RandomStream& stream) {
  constexpr float kWidth = 256.0F;
  constexpr float kHeight = 128.0F;
  canvas.add_octaves(2, 16, 0.05F, 0.3F, stream.bits());
  canvas.add_octaves(32, 256, 0.06F, 0.6F, stream.bits());
  for (float y = 0.0F; y < kTextureSize; y += kHeight) {
    for (float x = 0.0F; x < kTextureSize; x += kWidth) {
      const Eigen::Vector2f centre(x + 0.5F * kWidth, y + 0.5F * kHeight);
      canvas.add_box(centre, {0.5F * kWidth - 2.0F, 0.5F * kHeight - 2.0F}, 0.0F, 0.3F + draw(stream, -0.2, 0.2));
      for (const float sx : {-1.0F, -0.33F, 0.33F, 1.0F}) {
        for (const float sy : {-1.0F, 1.0F}) {
          canvas.add_disc(centre + Eigen::Vector2f(sx * (0.5F * kWidth - 10.0F), sy * (0.5F * kHeight - 10.0F)), 2.5F,
                          -0.55F);
        }
      }
      const Eigen::Vector2f text_corner =
          centre + Eigen::Vector2f(draw(stream, -100.0, 20.0), draw(stream, -20.0, 40.0));
      const float text_height = draw(stream, 8.0, 26.0);
      if (stream.uniform() < 0.6) canvas.add_text(text_corner, draw_letters(stream, 3), text_height, -0.5F);
    }
  }
  add_chips(canvas, 1.5F, 24.0F, 0.015F, 0.25F, stream);
}

/// A plate with a border, lettering and a block or two, as on notice boards, shop fronts and road works.
void draw_plate(TileCanvas& canvas, RandomStream& stream) {
  const Eigen::Vector2f centre = draw_place(stream);
  const Eigen::Vector2f half_size(draw(stream, 20.0, 90.0), draw(stream, 14.0, 50.0));
  const float tone = draw_sign(stream) * draw(stream, 0.25, 0.5);
  canvas.add_box(centre, half_size, 0.0F, tone);
  canvas.add_box(centre, half_size - Eigen::Vector2f::Constant(2.5F), 0.0F, -0.3F * tone);
  const float height = half_size.y() * draw(stream, 0.5, 0.9);
  const int letters = std::max(1, static_cast<int>(1.4F * half_size.x() / height));
  const Eigen::Vector2f corner = centre + Eigen::Vector2f(-0.8F * half_size.x(), 0.6F * height);
  canvas.add_text(corner, draw_letters(stream, letters), height, -1.1F * tone);
  const Eigen::Vector2f block = centre + Eigen::Vector2f(draw(stream, -0.8, 0.8) * half_size.x(), 0.8F * half_size.y());
  canvas.add_box(block, {draw(stream, 4.0, 14.0), draw(stream, 2.0, 6.0)}, 0.0F, draw_sign(stream) * 0.4F);
}

void draw_signs(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(2, 16, 0.06F, 0.2F, stream.bits());
  canvas.add_octaves(32, 256, 0.06F, 0.6F, stream.bits());
  add_chips(canvas, 1.5F, 24.0F, 0.012F, 0.25F, stream);
  for (int i = 0; i < 90; ++i) draw_plate(canvas, stream);
}

void draw_asphalt(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(2, 4, 0.16F, 0.5F, stream.bits());
  canvas.add_octaves(8, 256, 0.10F, 0.5F, stream.bits());
  add_chips(canvas, 1.2F, 2.4F, 0.05F, 0.35F, stream);
  add_chips(canvas, 5.0F, 60.0F, 0.025F, 0.25F, stream);
  add_cracks(canvas, 45, -0.35F, stream);
}

/// Rows of windows, 2.56 m apart both ways, each with panes, a sill and its own blind.
void draw_facade(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(2, 16, 0.05F, 0.2F, stream.bits());
  canvas.add_octaves(64, 256, 0.07F, 0.6F, stream.bits());
  constexpr float kPitch = kTextureSize / 2;
  for (int floor = 0; floor < 2; ++floor) {
    for (int column = 0; column < 2; ++column) {
      const Eigen::Vector2f centre((static_cast<float>(column) + 0.5F) * kPitch + draw(stream, -20.0, 20.0),
                                   (static_cast<float>(floor) + 0.5F) * kPitch);
      const Eigen::Vector2f half_size(draw(stream, 90.0, 140.0), draw(stream, 130.0, 165.0));
      canvas.add_box(centre, half_size + Eigen::Vector2f::Constant(14.0F), 0.0F, 0.45F);
      canvas.add_box(centre, half_size, 0.0F, -1.2F);
      const float blind = draw(stream, 0.0, 0.8) * half_size.y();
      canvas.add_box(centre - Eigen::Vector2f(0.0F, half_size.y() - blind), {half_size.x(), blind}, 0.0F,
                     draw(stream, 0.2, 0.9));
      canvas.add_box(centre, {5.0F, half_size.y()}, 0.0F, 0.7F);
      canvas.add_box(centre + Eigen::Vector2f(0.0F, half_size.y() + 22.0F), {half_size.x() + 24.0F, 9.0F}, 0.0F, 0.3F);
    }
    canvas.add_box({0.5F * kTextureSize, static_cast<float>(floor) * kPitch}, {0.5F * kTextureSize, 6.0F}, 0.0F,
                   -0.25F);
  }
  add_chips(canvas, 1.5F, 24.0F, 0.015F, 0.25F, stream);
}

/// Blades of all tones over lighter and darker patches, weeds and bare places.
void draw_grass(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(8, 256, 0.10F, 0.5F, stream.bits());
  for (int i = 0; i < 9000; ++i) {
    const float length = draw(stream, 4.0, 14.0);
    const Eigen::Vector2f place = draw_place(stream);
    const float angle = draw(stream, 0.0, 3.14159);
    canvas.add_box(place, {length, draw(stream, 0.6, 1.3)}, angle, draw(stream, -0.5, 0.5));
  }
  add_chips(canvas, 2.0F, 48.0F, 0.03F, 0.35F, stream);
  for (int i = 0; i < 120; ++i) canvas.add_disc(draw_place(stream), draw(stream, 3.0, 12.0), draw(stream, -0.5, 0.6));
}

/// Leaves over dark gaps.
void draw_foliage(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(8, 128, 0.12F, 0.6F, stream.bits());
  for (int i = 0; i < 5000; ++i) {
    const float size = draw(stream, 4.0, 13.0);
    const Eigen::Vector2f place = draw_place(stream);
    const float angle = draw(stream, 0.0, 3.14159);
    canvas.add_box(place, {size, size * draw(stream, 0.35, 0.6)}, angle, draw(stream, -0.45, 0.45));
  }
  add_chips(canvas, 2.0F, 32.0F, 0.03F, 0.4F, stream);
}

/// Stones of all sizes.
void draw_gravel(TileCanvas& canvas, RandomStream& stream) {
  canvas.add_octaves(2, 256, 0.09F, 0.4F, stream.bits());
  for (float radius = 1.5F; radius < 14.0F; radius *= 1.6F) {
    const int count = static_cast<int>(120000.0F / (radius * radius * 3.0F));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2f place = draw_place(stream);
      canvas.add_disc(place, radius * draw(stream, 0.7, 1.2), draw(stream, -0.5, 0.5));
    }
  }
  add_chips(canvas, 6.0F, 48.0F, 0.03F, 0.3F, stream);
}

void draw_plain(TileCanvas& canvas, RandomStream& stream) { canvas.add_octaves(256, 512, 0.02F, 0.0F, stream.bits()); }

void draw_structure(TileCanvas& canvas, Material::Pattern pattern, RandomStream& stream) {
  switch (pattern) {
    case Material::Pattern::kPlain:
      return draw_plain(canvas, stream);
    case Material::Pattern::kConcrete:
      return draw_concrete(canvas, stream);
    case Material::Pattern::kBrick:
      return draw_brick(canvas, stream);
    case Material::Pattern::kPanels:
      return draw_panels(canvas, stream);
    case Material::Pattern::kSigns:
      return draw_signs(canvas, stream);
    case Material::Pattern::kAsphalt:
      return draw_asphalt(canvas, stream);
    case Material::Pattern::kFacade:
      return draw_facade(canvas, stream);
    case Material::Pattern::kGrass:
      return draw_grass(canvas, stream);
    case Material::Pattern::kFoliage:
      return draw_foliage(canvas, stream);
    case Material::Pattern::kGravel:
      return draw_gravel(canvas, stream);
  }
}

void draw_wear(TileCanvas& canvas, Material::Pattern pattern, RandomStream& stream) {
  if (pattern == Material::Pattern::kPlain) return draw_plain(canvas, stream);
  canvas.add_octaves(4, 16, 0.08F, 0.5F, stream.bits());
  canvas.add_octaves(32, 512, 0.12F, 0.9F, stream.bits());
  add_chips(canvas, 1.5F, 48.0F, 0.035F, 0.30F, stream);
  add_cracks(canvas, 12, -0.3F, stream);
}

std::vector<float> halved(const std::vector<float>& fine, int size) {
  const int half = size / 2;
  std::vector<float> coarse(static_cast<std::size_t>(half) * static_cast<std::size_t>(half));
  for (int y = 0; y < half; ++y) {
    const float* upper = &fine[static_cast<std::size_t>(2 * y) * static_cast<std::size_t>(size)];
    const float* lower = upper + size;
    float* out = &coarse[static_cast<std::size_t>(y) * static_cast<std::size_t>(half)];
    for (int x = 0; x < half; ++x) {
      out[x] = 0.25F * (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
    }
  }
  return coarse;
}

Texture pyramid_of(const TileCanvas& canvas) {
  Texture texture{canvas.size(), {canvas.values()}};
  for (float& texel : texture.levels.front()) texel += 1.0F;
  for (int size = canvas.size(); size > 1; size /= 2) texture.levels.push_back(halved(texture.levels.back(), size));
  return texture;
}

template <typename Draw>
Texture make_texture(const Material& material, std::uint64_t seed, const char* purpose, Draw&& draw_pattern) {
  RandomStream stream(derive_seed(seed, purpose), material.name);
  TileCanvas canvas(kTextureSize);
  draw_pattern(canvas, material.pattern, stream);
  canvas.balance(kTextureRange);
  return pyramid_of(canvas);
}

}  // namespace

SurfaceTextures make_textures(const Material& material, std::uint64_t world_seed) {
  return {make_texture(material, world_seed, "texture structure", draw_structure),
          make_texture(material, world_seed, "texture wear", draw_wear)};
}

std::vector<SurfaceTextures> make_textures(const std::vector<Material>& materials, std::uint64_t world_seed) {
  std::vector<SurfaceTextures> textures(materials.size());
  tbb::parallel_for(std::size_t{0}, materials.size(),
                    [&](std::size_t i) { textures[i] = make_textures(materials[i], world_seed); });
  return textures;
}

}  // namespace plumbline
