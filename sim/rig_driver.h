#pragma once

#include <cstdint>
#include <memory>

#include "estimator/geometry/interpolation.h"
#include "sim/mjcf_model.h"
#include "sim/trajectory.h"

namespace plumbline {

/// The motion of a sensor pack fixed to a moving vehicle, from the vehicle's first knot to its last. Between knots
/// 10 ms apart, or as close as the vehicle's own where those are evenly closer, the pack's own spline is the truth, so
/// that every sensor on it sees one and the same motion.
Trajectory mounted_on(const Trajectory& world_from_vehicle, const Pose& vehicle_from_pack);

/// Carries the mocap rig body along a trajectory, in small steps of MuJoCo's kinematics, and keeps where it has been.
/// The rig is a child of the world that touches nothing, so that a model of it alone moves as it would among all the
/// geoms, whose number would otherwise be paid for in every step.
class RigDriver {
 public:
  /// The trajectory must outlive the driver; the track begins at stamp 0.
  explicit RigDriver(const Trajectory& world_from_body);
  RigDriver(const RigDriver&) = delete;
  RigDriver& operator=(const RigDriver&) = delete;
  ~RigDriver();

  /// Moves on until the track covers stamp_ns.
  void advance_to(std::int64_t stamp_ns);
  /// Drops what reading at or after stamp_ns does not need.
  void forget_before(std::int64_t stamp_ns) { track_.forget_before(stamp_ns); }
  const PoseTrack& world_from_body() const { return track_; }

 private:
  void step_to(std::int64_t stamp_ns);

  MjModelPtr model_;
  MjDataPtr data_;
  const Trajectory& trajectory_;
  int rig_body_ = -1;
  PoseTrack track_;
};

}  // namespace plumbline
