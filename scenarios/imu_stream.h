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
  /// When the next sample's interval ends: what it needs to know of the motion.
  std::int64_t next_over_ns() const { return (sample_ + decimation_) * imu_.period_ns(); }

 private:
  const Trajectory& world_from_body_;
  const int decimation_;
  Imu imu_;
  std::int64_t sample_ = 0;  // index of the last one
};

}  // namespace plumbline
