#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/messages.h"
#include "sim/random_stream.h"

namespace plumbline {

enum class FaultySensor { kImu, kCamera, kLidar };

enum class FaultKind {
  kDropOut,    ///< messages are lost
  kFreeze,     ///< the contents of the last good message, under new stamps
  kNan,        ///< IMU: all values; lidar: a share of the points
  kDuplicate,  ///< every message twice
  kReorder,    ///< a message arrives after the one that follows it
  kPartial,    ///< lidar: only the first share of a scan's time
  kSaturated,  ///< camera: the upper share of the rows reads 255
  kBlack       ///< camera: the upper share of the rows reads 0
};

/// What befalls a sensor's messages from one true time to another, start included.
struct Fault {
  FaultySensor sensor = FaultySensor::kLidar;
  FaultKind kind = FaultKind::kDropOut;
  double start_s = 0.0;
  double end_s = 0.0;
  double probability = 1.0;  ///< for each message within the time
  double share = 1.0;        ///< of a message that is hit, [0, 1]
};

/// Names as a scenario writes them, in the order of the enumerations.
const std::vector<std::string>& faulty_sensor_names();
const std::vector<std::string>& fault_kind_names();

/// Whether a sensor can have such a fault.
bool can_befall(FaultySensor sensor, FaultKind kind);

/// Spoils a message's contents. Kinds that leave the contents alone, or that this sensor cannot have, do nothing.
void spoil(ImuSample& sample, const Fault& fault, RandomStream& stream);
void spoil(CameraFrame& frame, const Fault& fault, RandomStream& stream);
/// A saturated or black sensor gives no depth.
void spoil(DepthFrame& frame, const Fault& fault, RandomStream& stream);
void spoil(LidarScan& scan, const Fault& fault, RandomStream& stream);

/// Puts an earlier message's contents under the stamps of `message`.
void freeze(ImuSample& message, const ImuSample& earlier);
void freeze(CameraFrame& message, const CameraFrame& earlier);
void freeze(DepthFrame& message, const DepthFrame& earlier);
void freeze(LidarScan& message, const LidarScan& earlier);

/// Which messages a fault hits. One per entry of a scenario's list, so that each draws from its own stream.
class FaultTrigger {
 public:
  /// @param index  of the fault in the scenario's list
  FaultTrigger(const Fault& fault, std::uint64_t seed, std::size_t index);

  const Fault& fault() const { return fault_; }
  /// Messages must come in order. @param true_ns  when the message was made
  bool hits(std::int64_t true_ns);
  RandomStream& stream() { return stream_; }

 private:
  Fault fault_;
  RandomStream stream_;
};

}  // namespace plumbline
