#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "estimator/messages.h"
#include "sim/world.h"

namespace plumbline {

using SensorPayload = std::variant<ImuSample, CameraFrame, DepthFrame, LidarScan>;

/// A message on its way from a sensor to the estimator.
struct SensorMessage {
  SensorPayload payload;
  std::int64_t delivery_ns = 0;  ///< when it is handed over: an image at its stamp, a scan at its end, or later
  double wall_s = 0.0;           ///< that making it took
  std::string lost;              ///< why it does not arrive; empty if it does
};

/// The factor on all lamps at a time: of the latest step that has begun, 1 before the first.
double light_factor_at(const std::vector<LightStep>& schedule, std::int64_t stamp_ns);

/// Makes a message and measures how long that takes.
template <typename Make>
std::unique_ptr<SensorMessage> timed_message(Make make, std::int64_t delivery_ns) {
  const auto start = std::chrono::steady_clock::now();
  auto message = std::make_unique<SensorMessage>();
  message->payload = make();
  message->delivery_ns = delivery_ns;
  message->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return message;
}

}  // namespace plumbline
