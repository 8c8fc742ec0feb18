#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace plumbline {

/// A square of grey values that wraps around at its edges, on which surface patterns are drawn. Lengths are in texels.
/// Zero is the surface's mean tone; +-1 would be twice the tone and black.
class TileCanvas {
 public:
  /// @param size  a power of two
  explicit TileCanvas(int size);

  int size() const { return size_; }
  float at(int x, int y) const { return values_[index(x, y)]; }
  const std::vector<float>& values() const { return values_; }

  /// Adds value noise with one random value per `cell` texels (a power of two), smooth between them.
  /// @param sharpness  0: plain noise; 1: blotches with an edge
  void add_noise(int cell, float amplitude, float sharpness, std::uint64_t seed);
  /// Adds octaves of equal amplitude with cells from `finest` to `coarsest`, so that contrast is there at every
  /// distance.
  void add_octaves(int finest, int coarsest, float amplitude, float sharpness, std::uint64_t seed);

  /// Adds `value` inside a rectangle turned by `angle`, its edge smoothed over a texel.
  void add_box(const Eigen::Vector2f& centre, const Eigen::Vector2f& half_size, float angle, float value);
  void add_disc(const Eigen::Vector2f& centre, float radius, float value);
  /// A line of given width that wanders from `start`: a crack.
  void add_crack(const Eigen::Vector2f& start, float length, float width, float value, std::uint64_t seed);
  /// Adds `value` where the text's strokes are; `corner` is the text's lower left.
  void add_text(const Eigen::Vector2f& corner, const std::string& text, float height, float value);

  /// Takes the mean away and limits all values to +-limit.
  void balance(float limit);

 private:
  std::size_t index(int x, int y) const {
    const int mask = size_ - 1;
    return static_cast<std::size_t>(y & mask) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x & mask);
  }
  template <typename Coverage>
  void add_shape(const Eigen::Vector2f& centre, const Eigen::Vector2f& half_extent, float value, Coverage&& coverage);

  int size_ = 0;
  std::vector<float> values_;
};

}  // namespace plumbline
