#pragma once

#include <functional>
#include <memory>

#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// Gives the next message at every call; null after the motion's end.
using MessageSource = std::function<std::unique_ptr<SensorMessage>()>;

/// Camera frames and lidar scans of a run, in order of delivery; at one time the frame comes first. Scans stand back to
/// back from time 0; frames are half a period off, so that they do not fall on the scans' ends. With a decimation of n
/// only every n-th message of each sensor is made. All references must outlive the source. The renderer's context
/// belongs to the calling thread.
MessageSource make_source(const Scenario& scenario, const Surroundings& surroundings,
                          const Trajectory& world_from_body);

/// The same messages, made ahead by a thread per sensor as far as bounded queues allow. The threads end with the
/// source; what they throw is thrown to the source's caller.
MessageSource make_read_ahead_source(const Scenario& scenario, const Surroundings& surroundings,
                                     const Trajectory& world_from_body);

}  // namespace plumbline
