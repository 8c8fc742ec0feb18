#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "sensors/lidar_model.h"
#include "sensors/lidar_pattern.h"
#include "sensors/lidar_signal.h"
#include "sim/surroundings.h"

namespace plumbline {

/// A point of a surface with its true normal, as a sensor would have it without any error.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m], in the sensor's frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit, in the sensor's frame, towards the sensor
};

/// What a lidar would return if it made no errors: the centre ray of every firing, where the surface it meets lies
/// within the device's range and is found at least half of the time.
class TrueReturns {
 public:
  /// @throws std::invalid_argument as validate_or_throw
  TrueReturns(const LidarModel& model, const Pose& body_from_lidar);

  struct Scan {
    /// In L as it stands at the message's end, the motion taken out. Only what stands still: the vehicle itself and
    /// what moves tell nothing of where the lidar is.
    std::vector<SurfacePoint> points;
    std::size_t fired = 0;
    std::size_t on_own_body = 0;
  };

  /// @param world_from_body  must cover the message
  /// @param every  casts the firings of every so manieth cycle only
  Scan cast(const Surroundings& surroundings, const PoseTrack& world_from_body, std::int64_t start_ns,
            std::int64_t scan_index, std::size_t every = 1) const;

  const LidarModel& model() const { return model_; }

 private:
  LidarModel model_;
  FiringPattern pattern_;
  LidarSignal signal_;
  Pose body_from_lidar_;
};

}  // namespace plumbline
