#pragma once

#include <optional>

#include "sim/vehicles/flight_reference.h"
#include "sim/vehicles/rotor_craft.h"
#include "sim/vehicles/wind.h"

namespace plumbline {

/// The quadrotor on a mission, step by step, with a controller that knows of the craft only what it is told: the same
/// craft, reference and wind as the quadrotor's own drive, which follows the truth. It stands on its pad, rotors at
/// hover, until the rest at the start is over.
class GuidedFlight {
 public:
  /// From a craft's middle to the tips of its rotors: what touches things [m].
  static constexpr double kReach_m = 0.32;

  /// @throws std::invalid_argument naming the field that cannot be used.
  GuidedFlight(const MotionConfig& config, const World& world, std::uint64_t seed);

  /// Goes on by RotorCraft::kStep_s.
  /// @param believed  what the craft takes for its state now, in the world; while it believes nothing it does not leave
  /// the pad, and in the air the rotors keep the thrust of hover.
  void step(const std::optional<FlightState>& believed);

  double time_s() const { return static_cast<double>(steps_) * RotorCraft::kStep_s; }
  double duration_s() const { return reference_.duration_s(); }
  bool on_pad() const { return !released_; }
  /// When the mission lets go of the pad.
  double release_s() const { return release_s_; }
  /// What the mission asks for now.
  FlightState wanted() const { return reference_.at(time_s()); }
  FlightState state() const { return craft_.state(); }
  Pose world_from_craft() const;

 private:
  RotorCraftDesign design_;
  FlightReference reference_;
  RotorCraft craft_;
  Wind wind_;
  double release_s_;
  bool released_ = false;
  std::int64_t steps_ = 0;
};

}  // namespace plumbline
