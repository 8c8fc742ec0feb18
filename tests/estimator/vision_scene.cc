#include "tests/estimator/vision_scene.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace plumbline::testing {

cv::Mat random_texture(int width, int height, std::uint64_t seed) {
  RandomStream random(seed, "texture");
  cv::Mat noise(height, width, CV_32F);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) noise.at<float>(y, x) = static_cast<float>(random.gaussian());
  }
  cv::GaussianBlur(noise, noise, cv::Size(0, 0), 2.0);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(noise, mean, deviation);
  cv::Mat grey;
  noise.convertTo(grey, CV_8U, 35.0 / deviation[0], 110.0);
  return grey;
}

TexturedPlane textured_plane(const Eigen::Vector3d& centre, const Eigen::Vector3d& along, const Eigen::Vector3d& down,
                             double width_m, double height_m, double metres_per_texel, std::uint64_t seed) {
  TexturedPlane plane{centre - 0.5 * width_m * along - 0.5 * height_m * down, along, down, {}, metres_per_texel};
  plane.texture = std::make_shared<cv::Mat>(random_texture(static_cast<int>(width_m / metres_per_texel),
                                                           static_cast<int>(height_m / metres_per_texel), seed));
  return plane;
}

Calibration vision_calibration() {
  Calibration calibration;
  calibration.camera = {640, 360, 474.0, 474.0, 319.5, 179.5};
  calibration.body_from_camera = {body_from_optical_rotation(), Eigen::Vector3d(0.12, -0.03, 0.05)};
  return calibration;
}

cv::Mat draw(const std::vector<TexturedPlane>& planes, const Calibration& calibration, const Pose& world_from_body) {
  const CameraIntrinsics& c = calibration.camera;
  const Pose camera_from_world = (world_from_body * calibration.body_from_camera).inverse();
  Eigen::Matrix3d k;
  k << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
  cv::Mat image(c.height, c.width, CV_8UC1, cv::Scalar(110));
  for (const TexturedPlane& plane : planes) {
    Eigen::Matrix3d columns;
    columns.col(0) = camera_from_world.rotation * plane.along * plane.metres_per_texel;
    columns.col(1) = camera_from_world.rotation * plane.down * plane.metres_per_texel;
    columns.col(2) = camera_from_world * plane.origin;
    const Eigen::Matrix3d h = k * columns;
    cv::Matx33d homography;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) homography(i, j) = h(i, j);
    }
    cv::warpPerspective(*plane.texture, image, homography, image.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  }
  return image;
}

CameraFrame expose(const cv::Mat& image, std::int64_t stamp_ns, double gain, double noise_dn, RandomStream& random) {
  CameraFrame frame{stamp_ns, 0, image.cols, image.rows, {}};
  frame.pixels.reserve(image.total());
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double value = gain * image.at<std::uint8_t>(y, x) + noise_dn * random.gaussian();
      frame.pixels.push_back(cv::saturate_cast<std::uint8_t>(value));
    }
  }
  return frame;
}

std::vector<Eigen::Vector3f> lidar_points(const std::vector<TexturedPlane>& planes, const Pose& world_from_body,
                                          double range_sigma_m, RandomStream& random) {
  std::vector<Eigen::Vector3f> points;
  for (int ring = 0; ring < 16; ++ring) {
    const double elevation = (-15.0 + 2.0 * ring) * M_PI / 180.0;
    for (double azimuth = -M_PI / 2; azimuth < M_PI / 2; azimuth += 0.2 * M_PI / 180.0) {
      const Eigen::Vector3d beam =
          world_from_body.rotation * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      double nearest = 100.0;
      for (const TexturedPlane& plane : planes) {
        const Eigen::Vector3d normal = plane.along.cross(plane.down);
        const double range = normal.dot(plane.origin - world_from_body.translation) / normal.dot(beam);
        if (!(range > 0.0 && range < nearest)) continue;
        const Eigen::Vector3d offset = world_from_body.translation + range * beam - plane.origin;
        const double u = offset.dot(plane.along) / plane.metres_per_texel;
        const double v = offset.dot(plane.down) / plane.metres_per_texel;
        if (u >= 0 && v >= 0 && u < plane.texture->cols && v < plane.texture->rows) nearest = range;
      }
      if (nearest >= 100.0) continue;
      const double measured = nearest + range_sigma_m * random.gaussian();
      points.push_back((world_from_body.translation + measured * beam).cast<float>());
    }
  }
  return points;
}

}  // namespace plumbline::testing
