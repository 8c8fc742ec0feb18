#include "scenarios/live_sensors.h"

namespace plumbline {
namespace {

template <typename Stream>
void measure_with(Stream& stream, SensorLink& link, std::int64_t known_ns) {
  for (std::int64_t over_ns = stream.next_over_ns(); over_ns <= known_ns; over_ns = stream.next_over_ns()) {
    auto message = stream.next();
    message->delivery_ns = over_ns;
    link.send(std::move(message));
  }
}

}  // namespace

LiveSensors::LiveSensors(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
                         int renderer_threads)
    : imu_(scenario, world_from_body),
      frames_(scenario, surroundings, world_from_body, renderer_threads),
      imu_link_(FaultySensor::kImu, scenario),
      frame_link_(FaultySensor::kCamera, scenario),
      scan_link_(FaultySensor::kLidar, scenario) {
  if (scenario.rig.has_lidar) scans_.emplace(scenario, surroundings, world_from_body);
}

void LiveSensors::measure(std::int64_t known_ns) {
  measure_with(imu_, imu_link_, known_ns);
  measure_with(frames_, frame_link_, known_ns);
  if (scans_) measure_with(*scans_, scan_link_, known_ns);
}

std::unique_ptr<SensorMessage> LiveSensors::next(std::int64_t now_ns) {
  SensorLink* earliest = nullptr;
  for (SensorLink* link : {&imu_link_, &frame_link_, &scan_link_}) {
    const SensorMessage* front = link->front();
    if (front == nullptr || front->delivery_ns > now_ns) continue;
    if (earliest == nullptr || front->delivery_ns < earliest->front()->delivery_ns) earliest = link;
  }
  return earliest == nullptr ? nullptr : earliest->take();
}

}  // namespace plumbline
