#pragma once

#include <cstdint>
#include <functional>

#include "scenarios/session.h"
#include "sensors/imu_model.h"
#include "sim/trajectory.h"

namespace plumbline {

/// The true poses of the IMU, which is the estimator's body, at every time that it measures.
class TruthLog {
 public:
  using Listener = std::function<void(std::int64_t stamp_ns, const Pose& world_from_body)>;

  /// The references must outlive this. @param end_ns  of the run
  TruthLog(const ImuModel& imu, const Trajectory& world_from_body, std::int64_t end_ns, const SessionOptions& options,
           const Listener& listener);

  /// Goes on to a time, included. @return false if the run is to end
  bool up_to(std::int64_t stamp_ns);

 private:
  const Trajectory& world_from_body_;
  const Pose body_from_imu_;
  const std::int64_t period_ns_;
  const std::int64_t count_;
  const SessionOptions& options_;
  const Listener& listener_;
  std::int64_t logged_ = 0;
};

}  // namespace plumbline
