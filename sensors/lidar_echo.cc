#include "sensors/lidar_echo.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

LidarEcho joined(const LidarEcho* first, const LidarEcho* last) {
  LidarEcho all;
  for (const LidarEcho* echo = first; echo != last; ++echo) {
    all.strength += echo->strength;
    all.range_m += echo->strength * echo->range_m;
  }
  all.range_m /= all.strength;
  double variance = 0.0;
  for (const LidarEcho* echo = first; echo != last; ++echo) {
    const double offset_m = echo->range_m - all.range_m;
    variance += echo->strength * (echo->spread_m * echo->spread_m + offset_m * offset_m);
  }
  all.spread_m = std::sqrt(variance / all.strength);
  return all;
}

}  // namespace

void LidarEchoes::merge(double resolution_m) {
  std::sort(begin(), end(), [](const LidarEcho& a, const LidarEcho& b) { return a.range_m < b.range_m; });
  std::size_t merged = 0;
  for (const LidarEcho* first = begin(); first != end();) {
    const LidarEcho* last = first + 1;
    while (last != end() && last->range_m - (last - 1)->range_m < resolution_m) ++last;
    echoes_[merged++] = joined(first, last);
    first = last;
  }
  size_ = merged;
}

}  // namespace plumbline
