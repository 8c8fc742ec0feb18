#include "sim/tile_canvas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

/// [-1, 1) from a lattice point.
float lattice_value(std::uint64_t seed, int x, int y) {
  const auto place = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) | static_cast<std::uint32_t>(x);
  return static_cast<float>(mix_bits(seed ^ place) >> 40) * 0x1.0p-23F - 1.0F;
}

float smooth_step(float t) { return t * t * (3.0F - 2.0F * t); }

}  // namespace

TileCanvas::TileCanvas(int size)
    : size_(size), values_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0F) {}

void TileCanvas::add_noise(int cell, float amplitude, float sharpness, std::uint64_t seed) {
  const int lattice = size_ / cell;
  std::vector<float> weights(static_cast<std::size_t>(cell));
  for (int i = 0; i < cell; ++i) {
    weights[static_cast<std::size_t>(i)] = smooth_step(static_cast<float>(i) / static_cast<float>(cell));
  }
  const auto knot_count = static_cast<std::size_t>(lattice) + 1;
  std::vector<float> knots(knot_count);
  std::vector<float> above(knot_count);
  std::vector<float> below(knot_count);
  const auto read_lattice = [&](std::vector<float>& row, int y) {
    for (int k = 0; k <= lattice; ++k) row[static_cast<std::size_t>(k)] = lattice_value(seed, k % lattice, y % lattice);
  };
  read_lattice(below, 0);
  Eigen::ArrayXf noise(size_);
  Eigen::ArrayXf steep(size_);
  for (int y = 0; y < size_; ++y) {
    if (y % cell == 0) {
      std::swap(above, below);
      read_lattice(below, y / cell + 1);
    }
    const float down = weights[static_cast<std::size_t>(y % cell)];
    for (std::size_t k = 0; k < knot_count; ++k) knots[k] = above[k] + (below[k] - above[k]) * down;
    float* into = noise.data();
    for (int k = 0; k < lattice; ++k) {
      const float left = knots[static_cast<std::size_t>(k)];
      const float step = knots[static_cast<std::size_t>(k) + 1] - left;
      for (const float weight : weights) *into++ = left + step * weight;
    }
    // Steepened around zero until, at 1, it is two tones with a soft edge.
    steep = (noise * (1.0F + 3.0F * sharpness)).min(1.0F).max(-1.0F);
    Eigen::Map<Eigen::ArrayXf>(&values_[index(0, y)], size_) +=
        amplitude * (noise + sharpness * (steep * (1.5F - 0.5F * steep * steep) - noise));
  }
}

void TileCanvas::add_octaves(int finest, int coarsest, float amplitude, float sharpness, std::uint64_t seed) {
  for (int cell = finest; cell <= coarsest; cell *= 2) {
    add_noise(cell, amplitude, sharpness, mix_bits(seed + static_cast<std::uint64_t>(cell)));
  }
}

template <typename Coverage>
void TileCanvas::add_shape(const Eigen::Vector2f& centre, const Eigen::Vector2f& half_extent, float value,
                           Coverage&& coverage) {
  const Eigen::Vector2i low = (centre - half_extent).array().floor().cast<int>();
  const Eigen::Vector2i high = (centre + half_extent).array().ceil().cast<int>();
  // Floats of their own: for all the compiler knows, a texel could be one of the centre's.
  const float middle_x = centre.x();
  const float middle_y = centre.y();
  for (int y = low.y(); y <= high.y(); ++y) {
    const float down = static_cast<float>(y) - middle_y;
    // Up to the tile's edge, and on from its other one.
    for (int x = low.x(); x <= high.x();) {
      float* const texels = &values_[index(x, y)];
      const int run = std::min(high.x() - x + 1, size_ - (x & (size_ - 1)));
      for (int i = 0; i < run; ++i) {
        const float right = static_cast<float>(x + i) - middle_x;
        texels[i] += value * std::max(0.0F, std::min(1.0F, coverage(right, down)));
      }
      x += run;
    }
  }
}

void TileCanvas::add_box(const Eigen::Vector2f& centre, const Eigen::Vector2f& half_size, float angle, float value) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  const Eigen::Vector2f extent(std::abs(c) * half_size.x() + std::abs(s) * half_size.y() + 1.0F,
                               std::abs(s) * half_size.x() + std::abs(c) * half_size.y() + 1.0F);
  const float half_x = half_size.x();
  const float half_y = half_size.y();
  add_shape(centre, extent, value, [c, s, half_x, half_y](float right, float down) {
    const float along = half_x - std::abs(c * right + s * down);
    const float across = half_y - std::abs(c * down - s * right);
    return std::max(0.0F, std::min(1.0F, along + 0.5F)) * std::max(0.0F, std::min(1.0F, across + 0.5F));
  });
}

void TileCanvas::add_disc(const Eigen::Vector2f& centre, float radius, float value) {
  add_shape(centre, Eigen::Vector2f::Constant(radius + 1.0F), value,
            [radius](float right, float down) { return radius + 0.5F - std::sqrt(right * right + down * down); });
}

void TileCanvas::add_crack(const Eigen::Vector2f& start, float length, float width, float value, std::uint64_t seed) {
  RandomStream stream(seed, "crack");
  Eigen::Vector2f point = start;
  auto heading = static_cast<float>(stream.uniform(0.0, 6.2831853));
  for (float done = 0.0F; done < length;) {
    const auto step = static_cast<float>(stream.uniform(6.0, 30.0));
    const Eigen::Vector2f direction(std::cos(heading), std::sin(heading));
    add_box(point + 0.5F * step * direction, {0.5F * step, 0.5F * width}, heading, value);
    point += step * direction;
    heading += static_cast<float>(stream.uniform(-0.8, 0.8));
    done += step;
  }
}

void TileCanvas::add_text(const Eigen::Vector2f& corner, const std::string& text, float height, float value) {
  // OpenCV's Hershey capitals are 21 units high at scale 1.
  const double scale = static_cast<double>(height) / 21.0;
  const int stroke = std::max(1, static_cast<int>(height / 6.0F));
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, stroke, &baseline);
  cv::Mat1b mask(extent.height + 2 * stroke, extent.width + 2 * stroke, std::uint8_t{0});
  cv::putText(mask, text, {stroke, extent.height + stroke}, cv::FONT_HERSHEY_SIMPLEX, scale, 255, stroke, cv::LINE_AA);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const std::size_t texel = index(static_cast<int>(corner.x()) + x, static_cast<int>(corner.y()) - mask.rows + y);
      values_[texel] += value * static_cast<float>(mask(y, x)) / 255.0F;
    }
  }
}

void TileCanvas::balance(float limit) {
  // Cutting the extremes shifts the mean a little, so the mean goes twice.
  for (int pass = 0; pass < 2; ++pass) {
    const double sum = std::accumulate(values_.begin(), values_.end(), 0.0);
    const auto mean = static_cast<float>(sum / static_cast<double>(values_.size()));
    for (float& value : values_) value = std::clamp(value - mean, -limit, limit);
  }
}

}  // namespace plumbline
