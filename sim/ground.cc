#include "sim/ground.h"

#include <cmath>
#include <limits>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxTiles = 512;  // 16 kB each
constexpr double kLevel_m = 2.0;        // a road and the bridge over it are different ground
constexpr double kWindowReuse_m = 6.0;  // less than what a window allows its rays' starts
constexpr double kLongestWave_m = 3.2;
constexpr int kOctaves = 5;

double draw(std::uint64_t seed, long ix, long iy) {
  const std::uint64_t bits = mix_bits(mix_bits(seed + static_cast<std::uint64_t>(ix)) + static_cast<std::uint64_t>(iy));
  return static_cast<double>(bits >> 11U) * 0x1p-52 - 1.0;
}

/// Draws at whole numbers, blended smoothly between.
double value_noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto ix = static_cast<long>(fx);
  const auto iy = static_cast<long>(fy);
  const auto ease = [](double u) { return u * u * (3.0 - 2.0 * u); };
  const double u = ease(x - fx);
  const double v = ease(y - fy);
  const double low = (1.0 - u) * draw(seed, ix, iy) + u * draw(seed, ix + 1, iy);
  const double high = (1.0 - u) * draw(seed, ix, iy + 1) + u * draw(seed, ix + 1, iy + 1);
  return (1.0 - v) * low + v * high;
}

}  // namespace

Ground::Ground(const World& world, const RayScene& rays, double cell_m, double roughness_m, std::uint64_t seed)
    : world_(world), rays_(rays), cell_m_(cell_m), roughness_m_(roughness_m), seed_(derive_seed(seed, "ground")) {}

double Ground::height(double x, double y, double route_z) {
  const double gx = x / cell_m_;
  const double gy = y / cell_m_;
  const auto ix = static_cast<long>(std::floor(gx));
  const auto iy = static_cast<long>(std::floor(gy));
  const double u = gx - static_cast<double>(ix);
  const double v = gy - static_cast<double>(iy);
  const double low = (1.0 - u) * node(ix, iy, route_z) + u * node(ix + 1, iy, route_z);
  const double high = (1.0 - u) * node(ix, iy + 1, route_z) + u * node(ix + 1, iy + 1, route_z);
  return (1.0 - v) * low + v * high;
}

double Ground::node(long ix, long iy, double route_z) {
  const auto tile_of = [](long i) { return i >= 0 ? i / kTile : (i + 1) / kTile - 1; };
  const long tx = tile_of(ix);
  const long ty = tile_of(iy);
  Tile& tile = tile_at({tx, ty, std::lround(route_z / kLevel_m)});
  float& height = tile[static_cast<std::size_t>((iy - ty * kTile) * kTile + ix - tx * kTile)];
  if (std::isnan(height)) {
    const double x = static_cast<double>(ix) * cell_m_;
    const double y = static_cast<double>(iy) * cell_m_;
    height = static_cast<float>(measured(x, y, route_z) + (roughness_m_ > 0.0 ? bumps(x, y) : 0.0));
  }
  return height;
}

Ground::Tile& Ground::tile_at(const TileKey& key) {
  if (last_tile_ != nullptr && last_key_ == key) return *last_tile_;
  if (tiles_.size() >= kMaxTiles) tiles_.clear();  // long drives come back to few places
  Tile& tile = tiles_[key];
  if (tile.empty()) tile.assign(kTile * kTile, std::numeric_limits<float>::quiet_NaN());
  last_key_ = key;
  last_tile_ = &tile;
  return tile;
}

double Ground::measured(double x, double y, double route_z) {
  Eigen::Vector3d from(x, y, route_z + kAbove_m);
  if (!window_ || (from - window_place_).norm() > kWindowReuse_m) {
    window_ = rays_.window(from, kAbove_m + kBelow_m);
    window_place_ = from;
  }
  double left_m = kAbove_m + kBelow_m;
  while (left_m > 0.0) {
    const RayHit hit = window_->cast(from, -Eigen::Vector3d::UnitZ(), 0.0, left_m, 0.0);
    if (!hit.hit) break;
    if (world_.mover_of(hit.geom) < 0) return from.z() - hit.range_m;
    const double past_m = hit.range_m + 0.01;
    from.z() -= past_m;
    left_m -= past_m;
  }
  return route_z;
}

double Ground::bumps(double x, double y) const {
  constexpr double kDeviation = 0.41;  // of value_noise
  double sum = 0.0;
  double variance = 0.0;
  double wave_m = kLongestWave_m;
  for (int octave = 0; octave < kOctaves; ++octave, wave_m /= 2.0) {
    // A spectrum that falls with the square leaves each octave a variance that grows with its wave length.
    const double weight = std::sqrt(wave_m);
    // Two draws to a wave; the lattices of the octaves are shifted against each other.
    const double shift = 0.37 * octave;
    sum += weight *
           value_noise(seed_ + static_cast<std::uint64_t>(octave), 2.0 * x / wave_m + shift, 2.0 * y / wave_m + shift);
    variance += weight * weight;
  }
  return roughness_m_ * sum / (kDeviation * std::sqrt(variance));
}

}  // namespace plumbline
