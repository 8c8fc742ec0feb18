#include "estimator/lidar/own_body_mask.h"

#include <algorithm>

namespace plumbline {
namespace {

// A carrier is not quite rigid, and extrinsics are not exact.
constexpr double kMargin_m = 0.03;
constexpr double kMarginSigmas = 3.0;

}  // namespace

OwnBodyMask::OwnBodyMask(const Calibration& calibration) {
  const double margin_m = kMargin_m + kMarginSigmas * calibration.lidar_range_sigma_m;
  for (const OwnPart& part : calibration.own_body) {
    const Pose box_from_lidar = part.body_from_part.inverse() * calibration.body_from_lidar;
    const Eigen::Vector3d half_size = part.half_size_m + Eigen::Vector3d::Constant(margin_m);
    boxes_.push_back({box_from_lidar.rotation.toRotationMatrix().cast<float>(),
                      box_from_lidar.translation.cast<float>(), half_size.cast<float>()});
    const double reach_m = box_from_lidar.translation.norm() + half_size.norm();
    reach_m_ = std::max(reach_m_, static_cast<float>(reach_m));
  }
}

bool OwnBodyMask::covers(const Eigen::Vector3f& position_in_lidar) const {
  if (position_in_lidar.squaredNorm() > reach_m_ * reach_m_) return false;
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& box) {
    const Eigen::Vector3f inside = box.box_from_lidar_rotation * position_in_lidar + box.box_from_lidar_translation;
    return (inside.cwiseAbs().array() <= box.half_size.array()).all();
  });
}

}  // namespace plumbline
