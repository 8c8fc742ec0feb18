#include "scenarios/scan_stream.h"

namespace plumbline {

ScanStream::ScanStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body)
    : scenario_(scenario),
      surroundings_(surroundings),
      world_from_body_(world_from_body),
      driver_(world_from_body),
      lidar_(scenario.rig.lidar, scenario.rig.pack_from_lidar, scenario.seed, scenario.rig.lidar_effects,
             scenario.rig.lidar_returns),
      parts_(messages_per_sweep(scenario.rig.lidar)) {}

std::unique_ptr<SensorMessage> ScanStream::next() {
  const std::int64_t start_ns = scan_ * lidar_.period_ns();
  const std::int64_t end_ns = next_over_ns();
  if (end_ns > world_from_body_.end_ns()) return nullptr;
  auto message = timed_message([&] { return cast(start_ns, end_ns); }, end_ns);
  ++scan_;
  if (scan_ % parts_ == 0) scan_ += (scenario_.rig.decimation - 1) * parts_;  // whole sweeps are left out
  return message;
}

LidarScan ScanStream::cast(std::int64_t start_ns, std::int64_t end_ns) {
  driver_.advance_to(end_ns);
  LidarScan scan = lidar_.scan(surroundings_, driver_.world_from_body(), start_ns, scan_);
  driver_.forget_before(end_ns);
  return scan;
}

}  // namespace plumbline
