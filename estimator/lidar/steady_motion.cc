#include "estimator/lidar/steady_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

// How restless a carrier is: after a second its velocity and rate are others by so much.
constexpr double kVelocityWalk = 1.0;  // [m/s/sqrt(s)]
constexpr double kRateWalk = 0.5;      // [rad/s/sqrt(s)]
// Before anything is known of the motion: a car on a road, turning.
constexpr double kUnknownVelocity_mps = 10.0;
constexpr double kUnknownRate = 0.5;
// Attitude that is read, not estimated, is beyond correction.
constexpr double kReadAttitude = 1e-6;  // [rad]
constexpr int kChangesRemembered = 10;
// A straight line fitted from 0 to T to a t^2 / 2 ends a T^2 / 8 off, where the rate has changed by a T.
constexpr double kBendOfChange = 1.0 / 8.0;

}  // namespace

void SteadyMotion::predict(const InertialSegment& segment) {
  const double h = seconds_between(segment.start_ns, segment.end_ns);
  Pose& pose = state_.world_from_body;
  const Eigen::Vector3d rate = turns_ ? rate_ : segment.rate;
  const Eigen::Quaterniond half = pose.rotation * exp_so3(0.5 * h * rate);
  state_.velocity_in_world = turns_ ? half * velocity_in_body_ : state_.velocity_in_world;
  pose.translation += h * state_.velocity_in_world;
  pose.rotation = (pose.rotation * exp_so3(h * rate)).normalized();
  state_.stamp_ns = segment.end_ns;
}

void SteadyMotion::follow(const Pose& world_from_body, const Pose& earlier_from_body, double duration_s) {
  move(world_from_body);
  const Eigen::Vector3d rate_before = rate_;
  const Eigen::Vector3d velocity_before = velocity_in_body_;
  rate_ = log_so3(earlier_from_body.rotation) / duration_s;
  // The chord's direction is that of half the turn, from which the body has turned on by the other half.
  const Eigen::Vector3d chord = earlier_from_body.translation / duration_s;
  const Eigen::Quaterniond world_from_earlier = world_from_body.rotation * earlier_from_body.rotation.conjugate();
  state_.velocity_in_world = world_from_earlier * chord;
  velocity_in_body_ = exp_so3(-0.5 * duration_s * rate_) * chord;
  duration_s_ = duration_s;
  if (std::exchange(known_, true)) {
    const double share = 1.0 / std::min(++changes_, kChangesRemembered);
    rate_change_square_ += share * ((rate_ - rate_before).squaredNorm() / 3.0 - rate_change_square_);
    velocity_change_square_ +=
        share * ((velocity_in_body_ - velocity_before).squaredNorm() / 3.0 - velocity_change_square_);
  }
}

Pose SteadyMotion::onwards(const Pose& from, double duration_s, const Pose& read) const {
  if (!turns_) return {read.rotation, from.translation + duration_s * state_.velocity_in_world};
  const Eigen::Quaterniond half = from.rotation * exp_so3(0.5 * duration_s * rate_);
  return {(from.rotation * exp_so3(duration_s * rate_)).normalized(),
          from.translation + duration_s * (half * velocity_in_body_)};
}

void SteadyMotion::move(const Pose& world_from_body) { state_.world_from_body = world_from_body; }

Matrix6d SteadyMotion::motion_covariance(double duration_s) const {
  const double root = std::sqrt(duration_s);
  const double angle = turns_ ? duration_s * (known_ ? kRateWalk * root : kUnknownRate) : kReadAttitude;
  const double distance = duration_s * (known_ ? kVelocityWalk * root : kUnknownVelocity_mps);
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(angle * angle);
  covariance.diagonal().tail<3>().setConstant(distance * distance);
  return covariance;
}

Matrix6d SteadyMotion::bend_covariance() const {
  const double bend_s = kBendOfChange * duration_s_;
  Matrix6d covariance = Matrix6d::Zero();
  if (turns_) covariance.diagonal().head<3>().setConstant(bend_s * bend_s * rate_change_square_);
  covariance.diagonal().tail<3>().setConstant(bend_s * bend_s * velocity_change_square_);
  return covariance;
}

}  // namespace plumbline
