#include "estimator/imu/mechanization.h"

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"

namespace plumbline {

InertialSegment InertialSegment::part(std::int64_t from_ns, std::int64_t to_ns) const {
  // Twice the shift of the middle, in integers, so that the whole interval gives exactly zero.
  const double shift_s = 0.5e-9 * static_cast<double>((from_ns - start_ns) + (to_ns - end_ns));
  return {from_ns, to_ns, rate + shift_s * rate_slope, force + shift_s * force_slope, rate_slope, force_slope};
}

InertialSegment segment_between(const ImuSample& previous, const ImuSample& sample) {
  const double dt = seconds_between(previous.stamp_ns, sample.stamp_ns);
  return {previous.stamp_ns,
          sample.stamp_ns,
          sample.angular_rate,
          sample.specific_force,
          (sample.angular_rate - previous.angular_rate) / dt,
          (sample.specific_force - previous.specific_force) / dt};
}

NavigationState mechanize(const NavigationState& state, const InertialSegment& segment) {
  const double h = seconds_between(segment.start_ns, segment.end_ns);
  const double h3 = h * h * h;
  const Eigen::Vector3d rate = segment.rate - state.gyro_bias;
  const Eigen::Vector3d force = segment.force - state.accel_bias;
  const Eigen::Vector3d angle = h * rate;
  const Eigen::Vector3d push = h * force;

  const Eigen::Vector3d coning = (h3 / 12.0) * rate.cross(segment.rate_slope);
  const Eigen::Vector3d sculling = (h3 / 12.0) * (force.cross(segment.rate_slope) + rate.cross(segment.force_slope));
  const Eigen::Vector3d turned = angle.cross(push);
  const Eigen::Vector3d delta_velocity = push + 0.5 * turned + angle.cross(turned) / 6.0 + sculling;
  const Eigen::Vector3d delta_position = 0.5 * h * push + (h / 6.0) * turned - (h3 / 12.0) * segment.force_slope;

  NavigationState next = state;
  next.stamp_ns = segment.end_ns;
  const Eigen::Quaterniond& r = state.world_from_body.rotation;
  next.world_from_body.rotation = (r * exp_so3(angle + coning)).normalized();
  next.velocity_in_world += r * delta_velocity + h * state.gravity_in_world;
  next.world_from_body.translation +=
      h * state.velocity_in_world + 0.5 * h * h * state.gravity_in_world + r * delta_position;
  return next;
}

}  // namespace plumbline
