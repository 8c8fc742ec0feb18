#include "scenarios/sensor_stream.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "scenarios/bounded_queue.h"
#include "scenarios/frame_stream.h"
#include "scenarios/imu_stream.h"
#include "scenarios/merged_source.h"
#include "scenarios/scan_stream.h"

namespace plumbline {
namespace {

// A second of frames and scans: enough to even out the load, 16 MB at most.
constexpr std::size_t kMessagesAhead = 60;

// Drawing is more than half of a run's work: on a thread of its own it would keep everyone waiting.
constexpr int kRendererThreads = 2;

template <typename Stream>
MessageSource source_of(std::shared_ptr<Stream> stream) {
  return [stream = std::move(stream)] { return stream->next(); };
}

/// Runs a stream in its own thread. Destruction stops the thread after the message it is at.
class ReadAhead {
 public:
  explicit ReadAhead(std::function<MessageSource()> make) : queue_(kMessagesAhead) {
    thread_ = std::thread([this, make = std::move(make)] { produce(make); });
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  ~ReadAhead() {
    queue_.abandon();
    thread_.join();
  }

  std::unique_ptr<SensorMessage> next() { return queue_.pop(); }

 private:
  void produce(const std::function<MessageSource()>& make) noexcept {
    try {
      const MessageSource source = make();
      while (auto message = source()) {
        if (!queue_.push(std::move(message))) return;
      }
      queue_.close();
    } catch (...) {
      queue_.close(std::current_exception());
    }
  }

  BoundedQueue<std::unique_ptr<SensorMessage>> queue_;
  std::thread thread_;
};

/// The lidar's scans; nothing, ever, where the rig has none.
MessageSource scans_of(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body) {
  if (!scenario.rig.has_lidar) return [] { return std::unique_ptr<SensorMessage>(); };
  return source_of(std::make_shared<ScanStream>(scenario, surroundings, world_from_body));
}

MessageSource linked(MessageSource source, FaultySensor sensor, const Scenario& scenario) {
  return [source = std::move(source), link = std::make_shared<SensorLink>(sensor, scenario)] {
    return link->next(source);
  };
}

/// The costly sensors as they come, the IMU, and everyone's way to the estimator.
MessageSource all_sensors(const Scenario& scenario, const Trajectory& world_from_body, MessageSource frames,
                          MessageSource scans) {
  MessageSource samples = source_of(std::make_shared<ImuStream>(scenario, world_from_body));
  return merged_sources(linked(std::move(samples), FaultySensor::kImu, scenario),
                        merged_sources(linked(std::move(frames), FaultySensor::kCamera, scenario),
                                       linked(std::move(scans), FaultySensor::kLidar, scenario)));
}

}  // namespace

double light_factor_at(const std::vector<LightStep>& schedule, std::int64_t stamp_ns) {
  double factor = 1.0;
  for (const auto& step : schedule) {
    if (step.start_s <= static_cast<double>(stamp_ns) * 1e-9) factor = step.factor;
  }
  return factor;
}

MessageSource make_source(const Scenario& scenario, const Surroundings& surroundings,
                          const Trajectory& world_from_body) {
  return all_sensors(scenario, world_from_body,
                     source_of(std::make_shared<FrameStream>(scenario, surroundings, world_from_body, 0)),
                     scans_of(scenario, surroundings, world_from_body));
}

MessageSource make_read_ahead_source(const Scenario& scenario, const Surroundings& surroundings,
                                     const Trajectory& world_from_body) {
  const auto frames = [&] {
    return source_of(std::make_shared<FrameStream>(scenario, surroundings, world_from_body, kRendererThreads));
  };
  const auto scans = [&] { return scans_of(scenario, surroundings, world_from_body); };
  return all_sensors(scenario, world_from_body, source_of(std::make_shared<ReadAhead>(frames)),
                     source_of(std::make_shared<ReadAhead>(scans)));
}

}  // namespace plumbline
