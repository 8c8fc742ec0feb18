#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "estimator/messages.h"
#include "sim/world.h"

namespace plumbline {

/// A message of the sensors that are costly to simulate; the IMU is not among them.
struct SensorMessage {
  std::variant<CameraFrame, DepthFrame, LidarScan> payload;
  std::int64_t delivery_ns = 0;  ///< when a driver hands it over: an image at its stamp, a scan at its end
  double wall_s = 0.0;           ///< that making it took
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
