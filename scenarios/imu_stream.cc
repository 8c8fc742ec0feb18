#include "scenarios/imu_stream.h"

namespace plumbline {

ImuStream::ImuStream(const Scenario& scenario, const Trajectory& world_from_body)
    : world_from_body_(world_from_body), decimation_(scenario.rig.decimation), imu_(scenario.rig.imu, scenario.seed) {
  imu_.noise_enabled = scenario.rig.imu_noise;
}

std::unique_ptr<SensorMessage> ImuStream::next() {
  const std::int64_t stamp_ns = next_over_ns();
  if (stamp_ns > world_from_body_.end_ns()) return nullptr;
  const auto make = [&] {
    // Those in between are made, too: the noise goes on whether or not a sample is sent.
    ImuSample sample;
    for (int i = 0; i < decimation_; ++i) sample = imu_.sample(world_from_body_, ++sample_ * imu_.period_ns());
    return sample;
  };
  return timed_message(make, stamp_ns);
}

}  // namespace plumbline
