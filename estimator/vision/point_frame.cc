#include "estimator/vision/point_frame.h"

#include <algorithm>

namespace plumbline {

std::vector<PointFrame::Point> sorted_points(const PointFrame& frame) {
  std::vector<PointFrame::Point> points = frame.points;
  if (std::any_of(points.begin(), points.end(), [](const auto& p) { return !p.pixel.allFinite(); })) return {};
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  points.erase(std::unique(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.id == b.id; }),
               points.end());
  return points;
}

const PointFrame::Point* find_point(const std::vector<PointFrame::Point>& sorted, std::int64_t id) {
  const auto at =
      std::lower_bound(sorted.begin(), sorted.end(), id,
                       [](const PointFrame::Point& point, std::int64_t wanted) { return point.id < wanted; });
  return at != sorted.end() && at->id == id ? &*at : nullptr;
}

}  // namespace plumbline
