#include "sim/textures.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumbline {
namespace {

using Pattern = Material::Pattern;

constexpr Pattern kPatterns[] = {Pattern::kPlain, Pattern::kConcrete, Pattern::kBrick, Pattern::kPanels,
                                 Pattern::kSigns, Pattern::kAsphalt,  Pattern::kWood,  Pattern::kFabric};

double mean_of(const std::vector<float>& texels) {
  return std::accumulate(texels.begin(), texels.end(), 0.0) / static_cast<double>(texels.size());
}

double deviation_of(const std::vector<float>& texels) {
  double squares = 0.0;
  for (const float texel : texels) squares += (texel - 1.0) * (texel - 1.0);
  return std::sqrt(squares / static_cast<double>(texels.size()));
}

void expect_sound(const Texture& texture) {
  ASSERT_EQ(texture.size, kTextureSize);
  ASSERT_EQ(texture.levels.size(), 11U);
  int size = texture.size;
  for (const auto& level : texture.levels) {
    EXPECT_EQ(level.size(), static_cast<std::size_t>(size * size));
    EXPECT_NEAR(mean_of(level), 1.0, 2e-3);
    size /= 2;
  }
  const auto [low, high] = std::minmax_element(texture.levels[0].begin(), texture.levels[0].end());
  EXPECT_GE(*low, 1.0F - kTextureRange - 1e-6F);
  EXPECT_LE(*high, 1.0F + kTextureRange + 1e-6F);
}

TEST(Textures, EveryLevelKeepsTheMaterialsAlbedo) {
  for (const Pattern pattern : kPatterns) {
    SCOPED_TRACE(static_cast<int>(pattern));
    const SurfaceTextures textures = make_textures(Material{.name = "a", .pattern = pattern}, 7);
    expect_sound(textures.structure);
    expect_sound(textures.wear);
  }
}

TEST(Textures, ContrastIsThereFromCentimetresToMetres) {
  for (const Pattern pattern : kPatterns) {
    if (pattern == Pattern::kPlain) continue;
    SCOPED_TRACE(static_cast<int>(pattern));
    const SurfaceTextures textures = make_textures(Material{.name = "a", .pattern = pattern}, 7);
    // Level 5 has texels of 16 cm: what it shows is larger than that, what it lacks is finer.
    const double coarse = deviation_of(textures.wear.levels[5]);
    const double all = deviation_of(textures.structure.levels[0]);
    const double upper = deviation_of(textures.structure.levels[3]);
    EXPECT_GT(coarse, 0.08);
    EXPECT_GT(upper, 0.05);
    EXPECT_GT(all * all - upper * upper, 0.05 * 0.05);
  }
}

/// Sums of the differences between neighbours along a row and down a column.
Eigen::Vector2d steps_along_and_down(const Texture& texture) {
  Eigen::Vector2d steps = Eigen::Vector2d::Zero();
  const auto at = [&](int x, int y) { return texture.levels[0][static_cast<std::size_t>(y * texture.size + x)]; };
  for (int y = 0; y + 1 < texture.size; ++y) {
    for (int x = 0; x + 1 < texture.size; ++x) {
      steps += Eigen::Vector2d(std::abs(at(x + 1, y) - at(x, y)), std::abs(at(x, y + 1) - at(x, y)));
    }
  }
  return steps;
}

TEST(Textures, StripesHaveEdgesOfOneDirectionOnly) {
  const auto upright = make_textures(Material{.name = "a", .pattern = Pattern::kStripesVertical}, 7);
  const auto level = make_textures(Material{.name = "a", .pattern = Pattern::kStripesHorizontal}, 7);
  const Eigen::Vector2d across = steps_along_and_down(upright.structure);
  const Eigen::Vector2d down = steps_along_and_down(level.structure);
  EXPECT_GT(across.x(), 1000.0);
  EXPECT_LT(across.y(), 1e-3 * across.x());
  EXPECT_GT(down.y(), 1000.0);
  EXPECT_LT(down.x(), 1e-3 * down.y());
  EXPECT_NEAR(deviation_of(upright.wear.levels[0]), 0.0, 1e-6);
  EXPECT_NEAR(deviation_of(level.wear.levels[0]), 0.0, 1e-6);
}

TEST(Textures, FollowSeedAndNameAndNothingElse) {
  const Material a{.name = "a"};
  const Material b{.name = "b"};
  const auto alone = make_textures(a, 7).structure.levels[0];
  const auto among_others = make_textures(std::vector<Material>{b, a}, 7);
  EXPECT_EQ(alone, among_others[1].structure.levels[0]);
  EXPECT_NE(alone, among_others[0].structure.levels[0]);
  EXPECT_NE(alone, make_textures(a, 8).structure.levels[0]);
}

TEST(Textures, TileWithoutASeam) {
  const Texture texture = make_textures(Material{.name = "a", .pattern = Pattern::kAsphalt}, 7).wear;
  const auto difference = [&](int x0, int x1) {
    double sum = 0.0;
    for (int y = 0; y < texture.size; ++y) {
      const auto row = static_cast<std::size_t>(y * texture.size);
      sum += std::abs(texture.levels[0][row + static_cast<std::size_t>(x0)] -
                      texture.levels[0][row + static_cast<std::size_t>(x1)]);
    }
    return sum;
  };
  double inside = 0.0;
  for (int x = 0; x + 1 < texture.size; ++x) inside = std::max(inside, difference(x, x + 1));
  EXPECT_LE(difference(texture.size - 1, 0), inside);
}

}  // namespace
}  // namespace plumbline
