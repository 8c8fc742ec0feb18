#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumbline {

/// Image points that someone else found and identified (a detector of markers, another tracker), in place of an image.
struct PointFrame {
  struct Point {
    std::int64_t id = 0;                              ///< of the thing seen: the same in every frame and camera
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< in the image as it came, distorted
  };

  std::int64_t stamp_ns = 0;
  int camera_id = 0;
  std::vector<Point> points;
};

/// A frame's points in the order of their identities, each once; none if any is not finite.
std::vector<PointFrame::Point> sorted_points(const PointFrame& frame);
/// The point of an identity among sorted ones, or null.
const PointFrame::Point* find_point(const std::vector<PointFrame::Point>& sorted, std::int64_t id);

}  // namespace plumbline
