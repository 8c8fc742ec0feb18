#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "estimator/estimator.h"
#include "estimator/messages.h"
#include "scenarios/scenario.h"
#include "sim/vehicles/flight_reference.h"

namespace plumbline {

/// What a craft's controller knows of the craft: the estimator's outputs, each from a latency after the IMU sample
/// that brought it, with the turn rate that this sample showed. Nothing here comes from the truth but the pad's pose,
/// as surveyed: it lays the mission out in the estimate's world, which is as little level as the accelerometers are
/// without bias.
class FlightGuidance {
 public:
  /// @param world_from_body_on_pad  of the IMU while the craft stands on its pad
  /// @param world_from_estimate     where the estimate's world lies, if it is a map whose place on the site is known:
  ///                                the mission is then laid out on the map, and the pad has no part in it
  FlightGuidance(const Scenario& scenario, const Pose& world_from_body_on_pad,
                 const std::optional<Pose>& world_from_estimate = std::nullopt);

  /// An output, as the sample that arrived at arrival_ns brought it. One that is not finite is not passed on.
  void add(const Odometry& output, const ImuSample& sample, std::int64_t arrival_ns);

  /// Without a map: the mission is laid out from where the newest estimate now takes the craft to stand; asked for on
  /// the pad.
  void lay_out(std::int64_t now_ns);

  /// The craft's state in the world, carried on from the newest estimate by its velocity and rate; nothing before there
  /// is one and the mission is laid out.
  std::optional<FlightState> believed(std::int64_t now_ns);

  /// The newest estimate that has come through, as world_from_body.
  struct Known {
    std::int64_t stamp_ns = 0;
    Pose world_from_body;
  };
  std::optional<Known> newest() const;

 private:
  struct Output {
    std::int64_t available_ns = 0;
    std::int64_t stamp_ns = 0;
    Pose frame_from_body;
    Eigen::Vector3d velocity_in_frame = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate_in_body = Eigen::Vector3d::Zero();
  };
  void let_through(std::int64_t now_ns);

  Pose world_from_body_on_pad_;
  bool on_map_;
  Pose body_from_craft_;
  std::int64_t latency_ns_;
  std::optional<Pose> world_from_frame_;  // the frame is the estimate's world
  std::optional<Output> current_;
  std::deque<Output> under_way_;
};

}  // namespace plumbline
