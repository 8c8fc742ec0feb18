#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/messages.h"

namespace plumbline {

/// A corner of a board and where a camera saw it.
struct BoardCorner {
  Eigen::Vector3d on_board = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     ///< distorted
};

/// camera_from_board by least squares of the pixels; empty for fewer than 12 corners, or if they do not fit to 2 px.
std::optional<Pose> pose_of_board(const std::vector<BoardCorner>& corners, const CameraIntrinsics& camera);

}  // namespace plumbline
