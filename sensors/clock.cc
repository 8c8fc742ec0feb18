#include "sensors/clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace plumbline {
namespace {

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace

void validate_or_throw(const ClockModel& model) {
  require(std::isfinite(model.offset_s), "clock: offset_s must be finite");
  require(std::abs(model.drift) <= 0.01, "clock: drift must be in [-0.01, 0.01]");
  require(std::isfinite(model.jitter_s) && model.jitter_s >= 0.0, "clock: jitter_s must be finite and not negative");
}

void validate_or_throw(const TransportModel& model) {
  require(std::isfinite(model.delay_s) && model.delay_s >= 0.0, "transport: delay_s must be finite and not negative");
  require(std::isfinite(model.jitter_s) && model.jitter_s >= 0.0,
          "transport: jitter_s must be finite and not negative");
}

SensorClock::SensorClock(const ClockModel& model, std::uint64_t seed, const std::string& sensor)
    : model_(model), stream_(seed, sensor + ".clock") {
  validate_or_throw(model_);
}

void SensorClock::restamp(LidarScan& scan) {
  const std::int64_t jitter = jitter_ns();
  scan.stamp_ns = shown(scan.stamp_ns) + jitter;
  scan.end_ns = shown(scan.end_ns) + jitter;
  if (model_.drift == 0.0) return;
  for (LidarPoint& point : scan.points) {
    point.offset_ns = static_cast<std::int32_t>(std::llround(point.offset_ns * (1.0 + model_.drift)));
  }
}

// Added up in whole nanoseconds, so that a perfect clock changes nothing.
std::int64_t SensorClock::shown(std::int64_t true_ns) const {
  return true_ns + nanoseconds(model_.offset_s) + std::llround(static_cast<double>(true_ns) * model_.drift);
}

std::int64_t SensorClock::jitter_ns() {
  return model_.jitter_s > 0.0 ? nanoseconds(model_.jitter_s * stream_.gaussian()) : 0;
}

Transport::Transport(const TransportModel& model, std::uint64_t seed, const std::string& sensor)
    : model_(model), stream_(seed, sensor + ".transport"), last_arrival_ns_(std::numeric_limits<std::int64_t>::min()) {
  validate_or_throw(model_);
}

std::int64_t Transport::arrival_ns(std::int64_t sent_ns) {
  const double jitter_s = model_.jitter_s > 0.0 ? model_.jitter_s * std::abs(stream_.gaussian()) : 0.0;
  last_arrival_ns_ = std::max(last_arrival_ns_, sent_ns + nanoseconds(model_.delay_s + jitter_s));
  return last_arrival_ns_;
}

}  // namespace plumbline
