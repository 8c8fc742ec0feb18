#include "sim/vehicles/guided_flight.h"

namespace plumbline {
namespace {

Pose pose_of(const FlightState& state) { return {state.attitude, state.position}; }

}  // namespace

GuidedFlight::GuidedFlight(const MotionConfig& config, const World& world, std::uint64_t seed)
    : reference_(config, world),
      craft_(design_, pose_of(reference_.at(0.0))),
      wind_(config.wind_mps, seed),
      release_s_(config.rest_s) {}

void GuidedFlight::step(const std::optional<FlightState>& believed) {
  const Eigen::Vector3d wind = wind_.next();
  released_ = released_ || (believed && time_s() >= release_s_);
  if (released_) {
    constexpr double kGravity = 9.81;
    const Wrench hover{design_.mass_kg * kGravity, Eigen::Vector3d::Zero()};
    craft_.step(believed ? track(design_, *believed, wanted()) : hover, wind);
  }
  ++steps_;
}

Pose GuidedFlight::world_from_craft() const { return pose_of(state()); }

}  // namespace plumbline
