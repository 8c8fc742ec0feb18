#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/messages.h"
#include "sim/random_stream.h"

namespace cv {
class Mat;
}

/// Textured planes drawn by homography: images, lidar-like points and poses that are exactly consistent.
namespace plumbline::testing {

/// Copies share their texture.
struct TexturedPlane {
  Eigen::Vector3d origin;  ///< in W, of the texture's top left corner
  Eigen::Vector3d along;   ///< unit, texture columns
  Eigen::Vector3d down;    ///< unit, texture rows
  std::shared_ptr<cv::Mat> texture;
  double metres_per_texel = 0.01;
};

/// Smooth random texture with detail of a few texels.
cv::Mat random_texture(int width, int height, std::uint64_t seed);

TexturedPlane textured_plane(const Eigen::Vector3d& centre, const Eigen::Vector3d& along, const Eigen::Vector3d& down,
                             double width_m, double height_m, double metres_per_texel, std::uint64_t seed);

/// The rig of these tests: 640x360 at 474 px, looking along x, a hand's breadth from the body's origin.
Calibration vision_calibration();

/// Draws planes in the given order (far ones first); all must lie wholly in front of the camera.
cv::Mat draw(const std::vector<TexturedPlane>& planes, const Calibration& calibration, const Pose& world_from_body);

/// Adds Gaussian noise and gain, rounds and clips, as a camera does.
CameraFrame expose(const cv::Mat& image, std::int64_t stamp_ns, double gain, double noise_dn, RandomStream& random);

/// Returns of a 16-beam lidar in the body's origin (30 degrees high, 0.2 degrees in azimuth, forward half), in W.
std::vector<Eigen::Vector3f> lidar_points(const std::vector<TexturedPlane>& planes, const Pose& world_from_body,
                                          double range_sigma_m, RandomStream& random);

}  // namespace plumbline::testing
