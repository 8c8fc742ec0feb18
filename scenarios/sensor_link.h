#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sensors/clock.h"
#include "sensors/faults.h"

namespace plumbline {

/// Gives the next message at every call; null after the motion's end.
using MessageSource = std::function<std::unique_ptr<SensorMessage>()>;

/// A sensor's way to the estimator: what befalls its messages, its clock, and the transport. Messages come in with true
/// stamps and times and go out stamped by the sensor's clock, in order of arrival. A lost message goes out marked as
/// such, so that it can be counted.
class SensorLink {
 public:
  SensorLink(MessageSource source, FaultySensor sensor, const Scenario& scenario);

  std::unique_ptr<SensorMessage> next();

 private:
  void send(std::unique_ptr<SensorMessage> message);
  void arrive(std::unique_ptr<SensorMessage> message, std::int64_t sent_ns);

  MessageSource source_;
  std::vector<FaultTrigger> faults_;
  bool keeps_last_ = false;            ///< a fault may ask for the last good message
  std::map<int, SensorPayload> last_;  ///< by camera
  std::unique_ptr<SensorMessage> held_back_;
  std::deque<std::unique_ptr<SensorMessage>> arrived_;
  SensorClock clock_;
  Transport transport_;
};

}  // namespace plumbline
