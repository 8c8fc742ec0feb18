#include "sim/vehicles/guided_flight.h"

#include "sim/constants.h"

namespace plumbline {
namespace {

// An estimate comes late. At a delay of 12 ms, a latency of 10 ms and half of a 5 ms sample, the attitude's loop
// crosses over at 31 rad/s with 43 degrees of phase left and would lose them at 37 ms; the place's loop is three times
// slower.
constexpr TrackingGains kGains{.place = 12.0, .velocity = 6.0, .attitude = 400.0, .rate = 28.0};

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
    const Wrench hover{design_.mass_kg * kGravity, Eigen::Vector3d::Zero()};
    craft_.step(believed ? track(design_, *believed, wanted(), kGains) : hover, wind);
  }
  ++steps_;
}

Pose GuidedFlight::world_from_craft() const { return pose_of(state()); }

}  // namespace plumbline
