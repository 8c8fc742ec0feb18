#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <variant>

#include "estimator/messages.h"
#include "scenarios/scenario.h"
#include "sim/ray_scene.h"
#include "sim/trajectory.h"

namespace plumbline {

/// A message of the sensors that are costly to simulate; the IMU is not among them.
struct SensorMessage {
  std::variant<CameraFrame, LidarScan> payload;
  std::int64_t delivery_ns = 0;  ///< when a driver hands it over: an image at its stamp, a scan at its end
  double wall_s = 0.0;           ///< that making it took
};

/// The factor on all lamps at a time: of the latest step that has begun, 1 before the first.
double light_factor_at(const std::vector<LightStep>& schedule, std::int64_t stamp_ns);

/// Gives the next message at every call; null after the motion's end.
using MessageSource = std::function<std::unique_ptr<SensorMessage>()>;

/// Camera frames and lidar scans of a run, in order of delivery; at one time the frame comes first. Scans stand back to
/// back from time 0; frames are half a period off, so that they do not fall on the scans' ends. With a decimation of n
/// only every n-th message of each sensor is made. All references must outlive the source. The renderer's context
/// belongs to the calling thread.
MessageSource make_source(const Scenario& scenario, const World& world, const RayScene& rays,
                          const Trajectory& world_from_body);

/// The same messages, made ahead by a thread per sensor as far as bounded queues allow. The threads end with the
/// source; what they throw is thrown to the source's caller.
MessageSource make_read_ahead_source(const Scenario& scenario, const World& world, const RayScene& rays,
                                     const Trajectory& world_from_body);

}  // namespace plumbline
