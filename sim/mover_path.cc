#include "sim/mover_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr double kWheelbase_m = 2.6;  // both ends of it are on the path, which takes the jerk out of its corners

}  // namespace

MoverPath::MoverPath(const Mover& mover)
    : points_(mover.path.points), closed_(mover.path.closed), speed_mps_(mover.speed_mps), start_m_(mover.start_m) {
  const auto require = [&](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument("scene: mover '" + mover.body + "': " + what);
  };
  require(points_.size() >= 2, "a path needs two points");
  require(std::isfinite(speed_mps_) && speed_mps_ > 0.0, "the speed must be positive");
  if (closed_) points_.push_back(points_.front());
  along_m_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    along_m_.push_back(along_m_.back() + (points_[i] - points_[i - 1]).norm());
  }
  require(std::isfinite(along_m_.back()) && along_m_.back() > 2.0 * kWheelbase_m, "the path is too short");
}

Eigen::Vector3d MoverPath::position_at(double along_m) const {
  const double length = along_m_.back();
  const double at = closed_ ? along_m - length * std::floor(along_m / length) : std::clamp(along_m, 0.0, length);
  const auto above = std::upper_bound(along_m_.begin() + 1, along_m_.end() - 1, at);
  const auto i = static_cast<std::size_t>(above - along_m_.begin());
  const double step = std::max(along_m_[i] - along_m_[i - 1], 1e-9);
  return points_[i - 1] + (at - along_m_[i - 1]) / step * (points_[i] - points_[i - 1]);
}

Pose MoverPath::at(double time_s) const {
  const double half = 0.5 * kWheelbase_m;
  double along = start_m_ + speed_mps_ * time_s;
  if (!closed_) {  // to the end, and again from the start
    const double run = along_m_.back() - kWheelbase_m;
    along = half + along - run * std::floor(along / run);
  }
  const Eigen::Vector3d rear = position_at(along - half);
  const Eigen::Vector3d front = position_at(along + half);
  const Eigen::Vector3d ahead = front - rear;
  const double yaw = std::atan2(ahead.y(), ahead.x());
  const double pitch = -std::atan2(ahead.z(), ahead.head<2>().norm());
  return {rotation_from_rpy({0.0, pitch, yaw}), 0.5 * (rear + front)};
}

}  // namespace plumbline
