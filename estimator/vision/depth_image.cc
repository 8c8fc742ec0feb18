#include "estimator/vision/depth_image.h"

#include <algorithm>
#include <cmath>

#include "estimator/vision/lens_pixels.h"
#include "estimator/vision/motion_constraints.h"

namespace plumbline {
namespace {

constexpr float kJumpShare = 0.1F;  // of the depth, from one pixel to the next but one

bool smooth_around(const DepthFrame& frame, int column, int row) {
  const auto at = [&](int u, int v) {
    return frame
        .depth_m[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(u)];
  };
  const float depth = at(column, row);
  if (!std::isfinite(depth) || depth <= 0.0F) return false;
  for (const float beside : {at(column - 1, row), at(column + 1, row), at(column, row - 1), at(column, row + 1)}) {
    if (!(std::abs(beside - depth) < kJumpShare * depth)) return false;
  }
  return true;
}

}  // namespace

std::vector<Eigen::Vector3f> depth_image_points(const DepthFrame& frame, const CameraIntrinsics& camera,
                                                double angular_spacing_deg) {
  std::vector<Eigen::Vector3f> points;
  const int step = std::max(1, static_cast<int>(camera.fx * std::tan(angular_spacing_deg * M_PI / 180.0)));
  for (int row = 1; row + 1 < frame.height; row += step) {
    for (int column = 1; column + 1 < frame.width; column += step) {
      if (!smooth_around(frame, column, row)) continue;
      const float depth = frame.depth_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                                        static_cast<std::size_t>(column)];
      const Eigen::Vector2f pixel(static_cast<float>(column), static_cast<float>(row));
      points.push_back((static_cast<double>(depth) * ray_through(camera, pinhole_pixel(camera, pixel))).cast<float>());
    }
  }
  return points;
}

}  // namespace plumbline
