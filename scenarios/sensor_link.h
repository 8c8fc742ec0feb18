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
  SensorLink(FaultySensor sensor, const Scenario& scenario);

  /// The next that arrives of what a source gives; null after its end.
  std::unique_ptr<SensorMessage> next(const MessageSource& source);

  /// Puts a message on its way; it is sent at its time of delivery.
  void send(std::unique_ptr<SensorMessage> message);
  /// The next of those sent that is to arrive, or null while there is none.
  const SensorMessage* front() const { return arrived_.empty() ? nullptr : arrived_.front().get(); }
  std::unique_ptr<SensorMessage> take();

 private:
  void arrive(std::unique_ptr<SensorMessage> message, std::int64_t sent_ns);

  std::vector<FaultTrigger> faults_;
  bool keeps_last_ = false;            ///< a fault may ask for the last good message
  std::map<int, SensorPayload> last_;  ///< by camera
  std::unique_ptr<SensorMessage> held_back_;
  std::deque<std::unique_ptr<SensorMessage>> arrived_;
  SensorClock clock_;
  Transport transport_;
};

}  // namespace plumbline
