#include "estimator/vision/lens_pixels.h"

namespace plumbline {

Eigen::Vector2d pinhole_pixel(const CameraIntrinsics& camera, const Eigen::Vector2f& image_pixel) {
  const Eigen::Vector2d pixel = image_pixel.cast<double>();
  if (camera.distortion.none()) return pixel;
  const Eigen::Array2d focal(camera.fx, camera.fy);
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d ideal = undistort(camera.distortion, ((pixel - centre).array() / focal).matrix());
  return (ideal.array() * focal).matrix() + centre;
}

Eigen::Vector2f image_pixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pinhole_pixel) {
  if (camera.distortion.none()) return pinhole_pixel.cast<float>();
  const Eigen::Array2d focal(camera.fx, camera.fy);
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d distorted = distort(camera.distortion, ((pinhole_pixel - centre).array() / focal).matrix());
  return ((distorted.array() * focal).matrix() + centre).cast<float>();
}

PixelBounds pinhole_bounds(const CameraIntrinsics& camera) {
  PixelBounds bounds{{0.0, 0.0}, {camera.width, camera.height}};
  if (camera.distortion.none()) return bounds;
  const auto include = [&](int u, int v) {
    const Eigen::Vector2d pixel = pinhole_pixel(camera, Eigen::Vector2i(u, v).cast<float>());
    bounds.least = bounds.least.cwiseMin(pixel);
    bounds.most = bounds.most.cwiseMax(pixel);
  };
  for (int u = 0; u < camera.width; ++u) {
    include(u, 0);
    include(u, camera.height - 1);
  }
  for (int v = 0; v < camera.height; ++v) {
    include(0, v);
    include(camera.width - 1, v);
  }
  return bounds;
}

}  // namespace plumbline
