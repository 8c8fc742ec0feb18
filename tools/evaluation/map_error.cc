#include "tools/evaluation/map_error.h"

#include <algorithm>
#include <cmath>

#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {
constexpr std::size_t kMaxPoints = 20'000;
}  // namespace

MapError map_error(const std::vector<MapPoint>& map, const Pose& truth_from_estimate,
                   const std::function<double(const Eigen::Vector3d&)>& distance_to_surface) {
  if (!distance_to_surface) return {};
  const std::size_t taken = std::min(map.size(), kMaxPoints);
  std::vector<double> distances;
  distances.reserve(taken);
  double square_sum = 0.0;
  for (std::size_t i = 0; i < taken; ++i) {
    const Eigen::Vector3d point = truth_from_estimate * map[i * map.size() / taken].position.cast<double>().eval();
    if (!point.allFinite()) continue;
    const double distance = std::min(distance_to_surface(point), kMapErrorLimit);
    if (!std::isfinite(distance)) continue;
    distances.push_back(distance);
    square_sum += distance * distance;
  }
  if (distances.empty()) return {};
  return {std::sqrt(square_sum / static_cast<double>(distances.size())), quantile(distances, 0.95)};
}

}  // namespace plumbline
