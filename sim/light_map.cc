#include "sim/light_map.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr int kWidth = 2048;
constexpr double kFinestTexel_m = 1.0 / 16.0;
constexpr double kCoarsestTexel_m = 1.0;
// A lamp at height h above a plate gives E ~ h / (h^2 + r^2)^(3/2). Filtering bilinearly between texels a distance s
// apart errs by s^2 / 8 (|Exx| + |Eyy|) <= 0.75 (s / h)^2 E, which is 0.5 % for this ratio of s to h.
constexpr double kTexelPerDistance = 0.08;

Eigen::AlignedBox3d bounds_of(const Polygon& piece) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& corner : piece) bounds.extend(corner);
  return bounds;
}

int rounded_up_to_power_of_two(int value) {
  int power = 1;
  while (power < value) power *= 2;
  return power;
}

}  // namespace

LightMapBuilder::LightMapBuilder(const std::vector<Lamp>& lamps) : lamps_(lamps) {
  // The first texel is for all that no lamp reaches.
  patches_.push_back({Eigen::Vector3d::Zero(),
                      Eigen::Vector3d::Zero(),
                      Eigen::Vector3d::Zero(),
                      Eigen::Vector3d::UnitZ(),
                      {1, 1},
                      reserve({1, 1}),
                      {}});
}

std::vector<int> LightMapBuilder::lamps_in_front(const Polygon& piece, const Eigen::Vector3d& normal,
                                                 const std::vector<int>& lamps) const {
  std::vector<int> in_front;
  std::copy_if(lamps.begin(), lamps.end(), std::back_inserter(in_front), [&](int lamp) {
    return normal.dot(lamps_[static_cast<std::size_t>(lamp)].position - piece.front()) > 0.0;
  });
  return in_front;
}

double LightMapBuilder::texel_size(const Polygon& piece, const std::vector<int>& lamps) const {
  const Eigen::AlignedBox3d bounds = bounds_of(piece);
  double nearest = kCoarsestTexel_m / kTexelPerDistance;
  for (const int lamp : lamps) {
    nearest = std::min(nearest, bounds.exteriorDistance(lamps_[static_cast<std::size_t>(lamp)].position));
  }
  return std::max(kTexelPerDistance * nearest, kFinestTexel_m);
}

/// Rectangles of similar height share a shelf.
Eigen::Vector2i LightMapBuilder::reserve(const Eigen::Vector2i& size) {
  const int shelf_height = rounded_up_to_power_of_two(size.y());
  const auto [entry, is_new] = shelf_of_height_.try_emplace(shelf_height);
  Shelf& shelf = entry->second;
  if (is_new || shelf.x + size.x() > kWidth) {
    shelf = {0, height_};
    height_ += shelf_height;
  }
  const Eigen::Vector2i place(shelf.x, shelf.y);
  shelf.x += size.x();
  return place;
}

std::vector<Eigen::Vector2f> LightMapBuilder::add(const Polygon& piece, const Eigen::Vector3d& normal,
                                                  const std::vector<int>& lamps) {
  const std::vector<int> shining = lamps_in_front(piece, normal, lamps);
  if (shining.empty()) return std::vector<Eigen::Vector2f>(piece.size(), Eigen::Vector2f::Constant(0.5F));

  const Eigen::Vector3d right = normal.unitOrthogonal();
  const Eigen::Vector3d down = normal.cross(right);
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3d& corner : piece) extent.extend(Eigen::Vector2d(right.dot(corner), down.dot(corner)));
  const Eigen::Vector2d intervals = (extent.sizes() / texel_size(piece, shining)).array().ceil().max(1.0);
  const Eigen::Vector2i size = intervals.cast<int>() + Eigen::Vector2i::Ones();
  const Eigen::Vector2d step = extent.sizes().cwiseQuotient(intervals).cwiseMax(1e-9);

  const Eigen::Vector3d origin =
      right * extent.min().x() + down * extent.min().y() + normal * normal.dot(piece.front());
  patches_.push_back({origin, right * step.x(), down * step.y(), normal, size, reserve(size), shining});
  std::vector<Eigen::Vector2f> places;
  for (const Eigen::Vector3d& corner : piece) {
    const Eigen::Vector2d texel =
        (Eigen::Vector2d(right.dot(corner), down.dot(corner)) - extent.min()).cwiseQuotient(step);
    places.push_back((patches_.back().place.cast<double>() + texel).cast<float>() + Eigen::Vector2f::Constant(0.5F));
  }
  return places;
}

double LightMapBuilder::illuminance(const Patch& patch, const Eigen::Vector3d& point) const {
  double lux = 0.0;
  for (const int index : patch.lamps) {
    const Lamp& lamp = lamps_[static_cast<std::size_t>(index)];
    const Eigen::Vector3d to_lamp = lamp.position - point;
    const double distance = to_lamp.norm();
    if (distance >= lamp.reach_m || distance <= 0.0) continue;
    const double height = std::max(patch.normal.dot(to_lamp), 0.0);
    lux += lamp.intensity_cd * height / (distance * distance * distance) * lamp_window(distance, lamp.reach_m);
  }
  return lux;
}

LightMap LightMapBuilder::light() const {
  LightMap map{kWidth, height_, {}};
  map.lux.resize(static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(height_));
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
    const Patch& patch = patches_[i];
    for (int y = 0; y < patch.size.y(); ++y) {
      const auto row =
          static_cast<std::size_t>(patch.place.y() + y) * kWidth + static_cast<std::size_t>(patch.place.x());
      for (int x = 0; x < patch.size.x(); ++x) {
        const Eigen::Vector3d point = patch.corner + x * patch.right + y * patch.down;
        map.lux[row + static_cast<std::size_t>(x)] = static_cast<float>(illuminance(patch, point));
      }
    }
  });
  return map;
}

}  // namespace plumbline
