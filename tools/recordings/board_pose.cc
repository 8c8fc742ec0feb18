#include "tools/recordings/board_pose.h"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "estimator/geometry/lens_distortion.h"
#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

constexpr std::size_t kLeastCorners = 12;
constexpr double kLargestError_px = 2.0;

/// Where a pinhole of focal length 1 would see them.
std::vector<cv::Point2d> ideal_points(const std::vector<BoardCorner>& corners, const CameraIntrinsics& camera) {
  std::vector<cv::Point2d> points;
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector2d ideal = undistort(
        camera.distortion,
        Eigen::Vector2d((corner.pixel.x() - camera.cx) / camera.fx, (corner.pixel.y() - camera.cy) / camera.fy));
    points.emplace_back(ideal.x(), ideal.y());
  }
  return points;
}

double rms_px(const std::vector<BoardCorner>& corners, const CameraIntrinsics& camera, const Pose& camera_from_board) {
  double sum = 0.0;
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector3d point = camera_from_board * corner.on_board;
    if (point.z() <= 0.0) return INFINITY;
    const Eigen::Vector2d seen = distort(camera.distortion, point.head<2>() / point.z());
    const Eigen::Vector2d pixel(camera.fx * seen.x() + camera.cx, camera.fy * seen.y() + camera.cy);
    sum += (pixel - corner.pixel).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(corners.size()));
}

}  // namespace

std::optional<Pose> pose_of_board(const std::vector<BoardCorner>& corners, const CameraIntrinsics& camera) {
  if (corners.size() < kLeastCorners) return std::nullopt;
  std::vector<cv::Point3d> on_board;
  for (const BoardCorner& corner : corners) {
    on_board.emplace_back(corner.on_board.x(), corner.on_board.y(), corner.on_board.z());
  }
  cv::Mat rotation, translation;
  try {
    if (!cv::solvePnP(on_board, ideal_points(corners, camera), cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation,
                      translation)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const auto vector_of = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  const Pose camera_from_board{exp_so3(vector_of(rotation)), vector_of(translation)};
  return rms_px(corners, camera, camera_from_board) < kLargestError_px ? std::optional(camera_from_board)
                                                                       : std::nullopt;
}

}  // namespace plumbline
