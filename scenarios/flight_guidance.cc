#include "scenarios/flight_guidance.h"

#include <cmath>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"

namespace plumbline {
FlightGuidance::FlightGuidance(const Scenario& scenario, const Pose& world_from_body_on_pad,
                               const std::optional<Pose>& world_from_estimate)
    : world_from_body_on_pad_(world_from_body_on_pad),
      on_map_(world_from_estimate.has_value()),
      body_from_craft_(
          (scenario.rig.vehicle_from_pack * Pose{Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body})
              .inverse()),
      latency_ns_(std::llround(scenario.motion.closed_loop.latency_s * 1e9)),
      world_from_frame_(world_from_estimate) {}

void FlightGuidance::add(const Odometry& output, const ImuSample& sample, std::int64_t arrival_ns) {
  const Eigen::Vector3d rate = sample.angular_rate - output.gyro_bias;
  const bool finite = output.world_from_body.translation.allFinite() &&
                      output.world_from_body.rotation.coeffs().allFinite() && output.velocity_in_world.allFinite() &&
                      rate.allFinite();
  if (!finite) return;
  under_way_.push_back(
      {arrival_ns + latency_ns_, output.stamp_ns, output.world_from_body, output.velocity_in_world, rate});
}

void FlightGuidance::let_through(std::int64_t now_ns) {
  while (!under_way_.empty() && under_way_.front().available_ns <= now_ns) {
    current_ = under_way_.front();
    under_way_.pop_front();
  }
}

void FlightGuidance::lay_out(std::int64_t now_ns) {
  let_through(now_ns);
  if (current_ && !on_map_) world_from_frame_ = world_from_body_on_pad_ * current_->frame_from_body.inverse();
}

std::optional<FlightState> FlightGuidance::believed(std::int64_t now_ns) {
  let_through(now_ns);
  if (!current_ || !world_from_frame_) return std::nullopt;
  const Pose world_from_body = *world_from_frame_ * current_->frame_from_body;
  const Eigen::Vector3d velocity = world_from_frame_->rotation * current_->velocity_in_frame;
  const Pose world_from_craft = world_from_body * body_from_craft_;
  const double age_s = seconds_between(current_->stamp_ns, now_ns);

  FlightState state;
  state.rate = body_from_craft_.rotation.conjugate() * current_->rate_in_body;
  state.velocity = velocity + world_from_body.rotation * current_->rate_in_body.cross(body_from_craft_.translation);
  state.position = world_from_craft.translation + age_s * state.velocity;
  state.attitude = (world_from_craft.rotation * exp_so3(age_s * state.rate)).normalized();
  return state;
}

std::optional<FlightGuidance::Known> FlightGuidance::newest() const {
  if (!current_ || !world_from_frame_) return std::nullopt;
  return Known{current_->stamp_ns, *world_from_frame_ * current_->frame_from_body};
}

}  // namespace plumbline
