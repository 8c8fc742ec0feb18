#pragma once

#include <cstdint>
#include <memory>

#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sensors/imu.h"
#include "sim/trajectory.h"

namespace plumbline {

/// The inertial unit on the moving rig.
class ImuStream {
 public:
  /// The arguments must outlive the stream.
  ImuStream(const Scenario& scenario, const Trajectory& world_from_body);

  /// The next sample; null after the motion's end.
  std::unique_ptr<SensorMessage> next();

 private:
  const Trajectory& world_from_body_;
  const int decimation_;
  Imu imu_;
  std::int64_t sample_ = 0;  // index of the last one
};

}  // namespace plumbline
