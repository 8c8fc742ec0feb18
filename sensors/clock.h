#pragma once

#include <cstdint>
#include <string>

#include "estimator/messages.h"
#include "sim/random_stream.h"

namespace plumbline {

/// How a sensor's own clock differs from true time.
struct ClockModel {
  double offset_s = 0.0;  ///< at time 0; positive: the clock is ahead
  double drift = 0.0;     ///< relative; positive: it runs fast
  double jitter_s = 0.0;  ///< of each message's stamp, one sigma
};

/// How long a message is on its way to the estimator.
struct TransportModel {
  double delay_s = 0.0;
  double jitter_s = 0.0;  ///< of what comes on top, the absolute value of a normal draw of this sigma
};

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const ClockModel& model);
void validate_or_throw(const TransportModel& model);

/// Stamps messages with a sensor's clock in place of true time.
class SensorClock {
 public:
  /// @param sensor  name of the stream of jitter
  SensorClock(const ClockModel& model, std::uint64_t seed, const std::string& sensor);

  /// Messages must come in order: each draws its jitter.
  template <typename Message>
  void restamp(Message& message) {
    message.stamp_ns = shown(message.stamp_ns) + jitter_ns();
  }
  /// The scan as a whole is shifted by one draw of jitter; its inner times stretch with the clock's drift.
  void restamp(LidarScan& scan);

 private:
  std::int64_t shown(std::int64_t true_ns) const;
  std::int64_t jitter_ns();

  ClockModel model_;
  RandomStream stream_;
};

/// Carries messages without overtaking.
class Transport {
 public:
  Transport(const TransportModel& model, std::uint64_t seed, const std::string& sensor);

  /// When a message sent at a time arrives; never before one that was sent earlier.
  std::int64_t arrival_ns(std::int64_t sent_ns);

 private:
  TransportModel model_;
  RandomStream stream_;
  std::int64_t last_arrival_ns_;
};

}  // namespace plumbline
