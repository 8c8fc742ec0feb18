#pragma once

#include "scenarios/scenario.h"
#include "scenarios/sensor_link.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// All messages of a run, in order of arrival; at one time the IMU sample comes first, then the frame, then the scan.
/// Scans stand back to back from time 0; frames are half a period off, so that they do not fall on the scans' ends.
/// With a decimation of n only every n-th message of each sensor is sent. All references must outlive the source. The
/// renderer's context belongs to the calling thread.
MessageSource make_source(const Scenario& scenario, const Surroundings& surroundings,
                          const Trajectory& world_from_body);

/// The same messages, frames and scans made ahead by a thread each as far as bounded queues allow. The threads end with
/// the source; what they throw is thrown to the source's caller.
MessageSource make_read_ahead_source(const Scenario& scenario, const Surroundings& surroundings,
                                     const Trajectory& world_from_body);

}  // namespace plumbline
