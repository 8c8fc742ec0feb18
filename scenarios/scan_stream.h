#pragma once

#include <cstdint>
#include <memory>

#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sensors/lidar.h"
#include "sim/rig_driver.h"
#include "sim/surroundings.h"

namespace plumbline {

/// The lidar on the moving rig.
class ScanStream {
 public:
  /// The arguments must outlive the stream.
  ScanStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body);

  /// The next scan; null after the motion's end.
  std::unique_ptr<SensorMessage> next();
  /// When the next scan ends: what it needs to know of the motion.
  std::int64_t next_over_ns() const { return (scan_ + 1) * lidar_.period_ns(); }

 private:
  LidarScan cast(std::int64_t start_ns, std::int64_t end_ns);

  const Scenario& scenario_;
  const Surroundings surroundings_;
  const Trajectory& world_from_body_;
  RigDriver driver_;
  Lidar lidar_;
  const int parts_;        // messages of a sweep
  std::int64_t scan_ = 0;  // index of the next one
};

}  // namespace plumbline
