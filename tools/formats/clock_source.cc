#include "tools/formats/clock_source.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

// Before the first message, so that the sweep during which it came has a clock, too.
constexpr std::int64_t kHeadStart_ns = 250'000'000;

std::unique_ptr<SensorMessage> tick(std::int64_t stamp_ns) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  return std::make_unique<SensorMessage>(SensorMessage{sample, stamp_ns, 0.0, {}});
}

class Clocked {
 public:
  Clocked(MessageSource messages, std::int64_t period_ns) : messages_(std::move(messages)), period_ns_(period_ns) {
    next_ = messages_();
    if (next_) last_tick_ns_ = next_->delivery_ns - kHeadStart_ns - period_ns_;
  }

  std::unique_ptr<SensorMessage> next() {
    if (closing_ns_) {
      last_tick_ns_ = *std::exchange(closing_ns_, std::nullopt);
      return tick(last_tick_ns_);
    }
    if (!next_) return nullptr;
    if (last_tick_ns_ + period_ns_ < next_->delivery_ns) return tick(last_tick_ns_ += period_ns_);
    auto message = std::exchange(next_, messages_());
    const bool more_at_this_time = next_ && next_->delivery_ns <= message->delivery_ns;
    if (!more_at_this_time && message->delivery_ns > last_tick_ns_) closing_ns_ = message->delivery_ns;
    return message;
  }

 private:
  MessageSource messages_;
  const std::int64_t period_ns_;
  std::unique_ptr<SensorMessage> next_;
  std::int64_t last_tick_ns_ = 0;
  std::optional<std::int64_t> closing_ns_;  // of the tick behind the message that was given last
};

}  // namespace

MessageSource with_clock(MessageSource messages, double rate_hz) {
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / rate_hz));
  return [clocked = std::make_shared<Clocked>(std::move(messages), period_ns)] { return clocked->next(); };
}

}  // namespace plumbline
