#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "scenarios/frame_stream.h"
#include "scenarios/imu_stream.h"
#include "scenarios/scan_stream.h"
#include "scenarios/scenario.h"
#include "scenarios/sensor_link.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// The sensors of a run whose motion is not known ahead: they measure as far as it is. Order and times are those of
/// make_source(), but that a frame is sent when its last light can have fallen.
class LiveSensors {
 public:
  /// The arguments must outlive this; the trajectory may grow. The renderer's context belongs to the calling thread.
  LiveSensors(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
              int renderer_threads);

  /// Measures all that ends up to a time, up to which the motion must be known.
  void measure(std::int64_t known_ns);
  /// The next message that has arrived by then, in order of arrival, or null.
  std::unique_ptr<SensorMessage> next(std::int64_t now_ns);

 private:
  ImuStream imu_;
  FrameStream frames_;
  std::optional<ScanStream> scans_;
  SensorLink imu_link_;
  SensorLink frame_link_;
  SensorLink scan_link_;
};

}  // namespace plumbline
