#include "scenarios/sensor_link.h"

#include <type_traits>
#include <utility>

namespace plumbline {
namespace {

std::string name_of(FaultySensor sensor) { return faulty_sensor_names().at(static_cast<std::size_t>(sensor)); }

const SensorTiming& timing_of(FaultySensor sensor, const RigConfig& rig) {
  switch (sensor) {
    case FaultySensor::kImu:
      return rig.imu_timing;
    case FaultySensor::kCamera:
      return rig.camera_timing;
    default:
      return rig.lidar_timing;
  }
}

void put_earlier_contents(SensorPayload& payload, const SensorPayload& earlier) {
  std::visit(
      [&](auto& message) {
        if (const auto* same_kind = std::get_if<std::decay_t<decltype(message)>>(&earlier)) freeze(message, *same_kind);
      },
      payload);
}

int camera_of(const CameraFrame& frame) { return frame.camera_id; }
int camera_of(const DepthFrame& frame) { return frame.camera_id; }
int camera_of(const ImuSample&) { return 0; }
int camera_of(const LidarScan&) { return 0; }

std::unique_ptr<SensorMessage> copy_of(const SensorMessage& message) {
  auto copy = std::make_unique<SensorMessage>(message);
  copy->wall_s = 0.0;
  return copy;
}

}  // namespace

SensorLink::SensorLink(FaultySensor sensor, const Scenario& scenario)
    : clock_(timing_of(sensor, scenario.rig).clock, scenario.seed, name_of(sensor)),
      transport_(timing_of(sensor, scenario.rig).transport, scenario.seed, name_of(sensor)) {
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const Fault& fault = scenario.faults[i];
    if (fault.sensor != sensor) continue;
    faults_.emplace_back(fault, scenario.seed, i);
    keeps_last_ = keeps_last_ || fault.kind == FaultKind::kFreeze;
  }
}

std::unique_ptr<SensorMessage> SensorLink::next(const MessageSource& source) {
  while (arrived_.empty()) {
    auto message = source();
    if (message) {
      send(std::move(message));
    } else if (held_back_) {
      const std::int64_t sent_ns = held_back_->delivery_ns;
      arrive(std::move(held_back_), sent_ns);
    } else {
      return nullptr;
    }
  }
  return take();
}

std::unique_ptr<SensorMessage> SensorLink::take() {
  auto message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

void SensorLink::send(std::unique_ptr<SensorMessage> message) {
  const std::int64_t sent_ns = message->delivery_ns;
  bool twice = false;
  bool late = false;
  bool frozen = false;
  const int camera = std::visit([](const auto& payload) { return camera_of(payload); }, message->payload);
  const auto last = last_.find(camera);
  for (FaultTrigger& trigger : faults_) {
    if (!trigger.hits(sent_ns)) continue;
    const Fault& fault = trigger.fault();
    twice = twice || fault.kind == FaultKind::kDuplicate;
    late = late || fault.kind == FaultKind::kReorder;
    if (fault.kind == FaultKind::kDropOut) message->lost = "lost on the way";
    if (fault.kind == FaultKind::kFreeze && last != last_.end()) {
      frozen = true;
      put_earlier_contents(message->payload, last->second);
    }
    std::visit([&](auto& payload) { spoil(payload, fault, trigger.stream()); }, message->payload);
  }
  if (keeps_last_ && !frozen) last_.insert_or_assign(camera, message->payload);
  std::visit([&](auto& payload) { clock_.restamp(payload); }, message->payload);

  if (late && !held_back_) {
    held_back_ = std::move(message);
    return;
  }
  auto second = twice ? copy_of(*message) : nullptr;
  arrive(std::move(message), sent_ns);
  if (second) arrive(std::move(second), sent_ns);
  if (held_back_) arrive(std::move(held_back_), sent_ns);
}

void SensorLink::arrive(std::unique_ptr<SensorMessage> message, std::int64_t sent_ns) {
  message->delivery_ns = transport_.arrival_ns(sent_ns);
  arrived_.push_back(std::move(message));
}

}  // namespace plumbline
