#pragma once

#include "scenarios/session.h"

namespace plumbline {

/// Runs a scenario in closed loop: the craft flies its mission on the estimator's outputs, the sensors measure what it
/// has flown, the estimator gets what they measured. All in turn and in virtual time: an output moves the rotors
/// `motion.closed_loop.latency_ms` after the arrival of the IMU sample that brought it, whatever the computer took.
/// The run ends with the mission, or where the craft strikes something or goes astray.
/// @throws InputError
RunRecord run_flight(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
                     Estimator& estimator);

/// Where the pack of sensors is while the craft stands on its pad. @throws InputError
Pose world_from_body_on_pad(const Scenario& scenario, const World& world);

}  // namespace plumbline
