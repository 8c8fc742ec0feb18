#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

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
  bool stands = false;  ///< on the world that stands still
  bool is_own = false;  ///< on the vehicle that carries the lidar

  bool is_none() const { return range_m == 0.0F; }
  /// Whether another ray's hit lies on this hit's plane, or both meet nothing.
  bool continues_in(const LidarHit& other) const;
};

/// How the head moves during one cycle: linear in time between the cycle's ends, which over 0.1 ms is the geodesic to
/// 1e-7 at 10 rad/s.
struct HeadMotion {
  std::int64_t begin_ps = 0;  ///< since the message's start
  double per_ps = 0.0;        ///< 1 / duration
  Eigen::Matrix3d rotation;   ///< world_from_head at the beginning
  Eigen::Matrix3d rotation_change;
  Eigen::Vector3d translation;
  Eigen::Vector3d translation_change;
  Eigen::Matrix3d vehicle_from_head;  ///< only with a vehicle in view
};

/// Casts the rays of one message, each from where the head is at the ray's own time.
class LidarCaster {
 public:
  /// @param world_from_body  covers the message; must outlive the caster, as the surroundings must
  /// @param own_body  nullptr: rays pass through the vehicle
  LidarCaster(const Surroundings& surroundings, const OwnBody* own_body, const PoseTrack& world_from_body,
              const Pose& body_from_lidar, const FiringPattern& pattern, std::int64_t start_ns, double max_range_m);

  /// Cheapest for cycles in time order.
  HeadMotion motion_of(const FiringPattern::Cycle& cycle);
  /// @param motion  of the ray's cycle
  /// @param time_ps  since the message's start, within the cycle
  LidarHit cast(const HeadMotion& motion, const HeadRay& ray, std::int64_t time_ps) const;

  struct Shot {
    const HeadMotion* motion = nullptr;
    HeadRay ray;
    std::int64_t time_ps = 0;
  };
  static constexpr std::size_t kMostTogether = RayPacket::kMost;
  /// The same for each of some shots, at most kMostTogether, and the same hits: cheapest for those that go about the
  /// same way.
  void cast(std::span<const Shot> shots, std::span<LidarHit> hits) const;

 private:
  struct Ray {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
  };

  Pose world_from_lidar(std::int64_t time_ps) const;
  Ray in_world(const HeadMotion& motion, const HeadRay& ray, std::int64_t time_ps) const;
  double seconds(std::int64_t time_ps) const;
  LidarHit hit_on(const World& world, const RayHit& hit, const Ray& ray) const;
  LidarHit hit_on_vehicle(const HeadMotion& motion, const HeadRay& ray, double max_range_m) const;
  /// @param hit  on the world
  LidarHit first_hit(const HeadMotion& motion, const HeadRay& ray, const Ray& in_world, const RayHit& hit) const;

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
  std::optional<RayWindow> own_window_;
  Pose vehicle_from_lidar_;
  std::int64_t end_ps_ = -1;  ///< of the last cycle asked for
  Pose world_from_lidar_at_end_;
};

}  // namespace plumbline
