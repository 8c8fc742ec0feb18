#include "estimator/lidar/poles.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr int kLeastReturns = 3;
constexpr float kLargestWidth_m = 0.6F;
constexpr float kClear_m = 0.3F;  // the least that what stands beside is further off
constexpr float kRangeSigmas = 4.0F;
// Of a circle's front, evenly looked at across its width: mean distance before its centre, over its radius.
constexpr float kMeanFront = 0.785F;  // pi / 4

/// Whether the surface goes on past the run's border at i, or something nearer may hide the border.
bool goes_on(const RingTable& table, int ring, int i, int beyond, float width_m) {
  if (beyond < table.ring_begin(ring) || beyond >= table.ring_end(ring)) return true;
  if (table.range(beyond) > table.range(i) + std::max(kClear_m, width_m)) return false;
  const float apart_m = (table.direction(i) - table.direction(beyond)).norm() * table.range(i);
  return table.adjacent_in_angle(i, beyond) || apart_m < 2.0F * width_m + kClear_m;
}

}  // namespace

std::optional<Pole> pole_of_run(const RingTable& table, int ring, int first, int end, float range_sigma) {
  const int count = end - first;
  if (count < kLeastReturns) return std::nullopt;
  const int last = end - 1;
  const float range = table.range(first + count / 2);
  const float step_m = table.beam_spacing(ring) * range;
  const float width_m = (table.direction(last) - table.direction(first)).norm() * range + step_m;
  if (width_m > kLargestWidth_m) return std::nullopt;
  float nearest = range;
  float farthest = range;
  for (int i = first; i < end; ++i) {
    nearest = std::min(nearest, table.range(i));
    farthest = std::max(farthest, table.range(i));
  }
  if (farthest - nearest > 0.5F * width_m + kRangeSigmas * range_sigma) return std::nullopt;
  if (goes_on(table, ring, first, first - 1, width_m) || goes_on(table, ring, last, end, width_m)) return std::nullopt;
  const int middle = first + count / 2;
  return Pole{middle, table.mean(first, last) + kMeanFront * 0.5F * width_m * table.beam(middle), 0.2F * step_m};
}

}  // namespace plumbline
