#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "estimator/geometry/interpolation.h"
#include "sensors/lidar_footprint.h"
#include "sensors/lidar_pattern.h"
#include "sim/surroundings.h"

namespace plumbline {

/// What a ray meets first.
struct LidarHit {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< relative to where the scan began, axes of the world
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, world
  float range_m = 0.0F;                              ///< 0: nothing
  float reflectivity = 0.0F;
  float cos_incidence = 0.0F;

  bool is_none() const { return range_m == 0.0F; }
  /// Whether another ray's hit lies on this hit's plane, or both meet nothing.
  bool continues_in(const LidarHit& other) const;
};

/// Casts the rays of one message, each from where the head is at the ray's own time.
class LidarCaster {
 public:
  /// @param world_from_body  covers the message; must outlive the caster, as the surroundings must
  /// @param own_body  nullptr: rays pass through the vehicle
  LidarCaster(const Surroundings& surroundings, const OwnBody* own_body, const PoseTrack& world_from_body,
              const Pose& body_from_lidar, const FiringPattern& pattern, std::int64_t start_ns, double max_range_m);

  /// The rays to come belong to this cycle. Costs nothing if those before did.
  void turn_to(const FiringPattern::Cycle& cycle);
  /// @param time_ps  since the message's start, within the cycle
  LidarHit cast(const HeadRay& ray, std::int64_t time_ps) const;

 private:
  struct Ray {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
  };

  Pose world_from_lidar(std::int64_t time_ps) const;
  Ray in_world(const HeadRay& ray, double ratio) const;
  LidarHit hit_on(const World& world, const RayHit& hit, const Ray& ray) const;

  const Surroundings& surroundings_;
  const OwnBody* own_body_;
  const PoseTrack& world_from_body_;
  const Pose body_from_lidar_;
  const std::int64_t cycle_ps_;
  const std::int64_t message_ps_;
  const std::int64_t start_ns_;
  const double max_range_m_;
  const Eigen::Vector3d place_;  ///< of the lidar as the message starts
  const RayWindow window_;
  Pose vehicle_from_lidar_;

  // Of the cycle: between its two ends both are linear in time, which over 0.1 ms is the geodesic to 1e-7 at 10 rad/s.
  std::int64_t cycle_offset_ps_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t begin_ps_ = 0;
  std::int64_t end_ps_ = -1;
  double per_ps_ = 0.0;
  Pose world_from_lidar_at_end_;
  Eigen::Matrix3d rotation_;  ///< world_from_head
  Eigen::Matrix3d rotation_change_;
  Eigen::Vector3d translation_;
  Eigen::Vector3d translation_change_;
  Eigen::Matrix3d vehicle_from_head_;
};

}  // namespace plumbline
