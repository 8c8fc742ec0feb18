#include "scenarios/truth_log.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

TruthLog::TruthLog(const ImuModel& imu, const Trajectory& world_from_body, std::int64_t end_ns,
                   const SessionOptions& options, const Listener& listener)
    : world_from_body_(world_from_body),
      body_from_imu_(Eigen::Quaterniond::Identity(), imu.position_in_body),
      period_ns_(std::llround(1e9 / imu.rate_hz)),
      count_(end_ns / period_ns_),
      options_(options),
      listener_(listener) {}

bool TruthLog::up_to(std::int64_t stamp_ns) {
  const std::int64_t samples_per_report = std::max<std::int64_t>(count_ / 200, 1);
  while (logged_ < count_ && (logged_ + 1) * period_ns_ <= stamp_ns) {
    const std::int64_t next_ns = ++logged_ * period_ns_;
    listener_(next_ns, world_from_body_.pose(next_ns) * body_from_imu_);
    if (options_.progress && logged_ % samples_per_report == 0 &&
        !options_.progress(static_cast<double>(logged_) / static_cast<double>(count_))) {
      return false;
    }
  }
  return true;
}

}  // namespace plumbline
