#include "sensors/lidar_caster.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// A step between surfaces below this changes a mixed return by less than the device's own noise.
constexpr float kStep_m = 0.02F;

}  // namespace

bool LidarHit::continues_in(const LidarHit& other) const {
  if (is_none() || other.is_none()) return is_none() && other.is_none();
  return std::abs(normal.dot(other.point - point)) < kStep_m;
}

LidarCaster::LidarCaster(const Surroundings& surroundings, const OwnBody* own_body, const PoseTrack& world_from_body,
                         const Pose& body_from_lidar, const FiringPattern& pattern, std::int64_t start_ns,
                         double max_range_m)
    : surroundings_(surroundings),
      own_body_(own_body),
      world_from_body_(world_from_body),
      body_from_lidar_(body_from_lidar),
      cycle_ps_(pattern.cycle_ps()),
      message_ps_(pattern.message_ps()),
      start_ns_(start_ns),
      max_range_m_(max_range_m),
      place_((world_from_body.at(start_ns) * body_from_lidar).translation),
      window_(surroundings.rays.window(place_, max_range_m)) {
  if (own_body_) vehicle_from_lidar_ = own_body_->body_from_vehicle.inverse() * body_from_lidar_;
}

Pose LidarCaster::world_from_lidar(std::int64_t time_ps) const {
  return world_from_body_.at(start_ns_ + (time_ps + 500) / 1000) * body_from_lidar_;
}

void LidarCaster::turn_to(const FiringPattern::Cycle& cycle) {
  if (cycle.offset_ps == cycle_offset_ps_) return;
  cycle_offset_ps_ = cycle.offset_ps;
  begin_ps_ = std::max<std::int64_t>(cycle.offset_ps, 0);
  const Pose begin = begin_ps_ == end_ps_ ? world_from_lidar_at_end_ : world_from_lidar(begin_ps_);
  end_ps_ = std::min(cycle.offset_ps + cycle_ps_, message_ps_);
  world_from_lidar_at_end_ = world_from_lidar(end_ps_);
  per_ps_ = 1.0 / static_cast<double>(end_ps_ - begin_ps_);

  rotation_ = begin.rotation.toRotationMatrix() * cycle.lidar_from_head;
  rotation_change_ = world_from_lidar_at_end_.rotation.toRotationMatrix() * cycle.lidar_from_head - rotation_;
  translation_ = begin.translation;
  translation_change_ = world_from_lidar_at_end_.translation - begin.translation;
  if (own_body_) vehicle_from_head_ = vehicle_from_lidar_.rotation.toRotationMatrix() * cycle.lidar_from_head;
}

LidarCaster::Ray LidarCaster::in_world(const HeadRay& ray, double ratio) const {
  const Eigen::Matrix3d rotation = rotation_ + ratio * rotation_change_;
  return {rotation * ray.origin_in_head + translation_ + ratio * translation_change_, rotation * ray.direction_in_head};
}

LidarHit LidarCaster::hit_on(const World& world, const RayHit& hit, const Ray& ray) const {
  const Material& material = world.materials()[static_cast<std::size_t>(world.material_of(hit.geom))];
  LidarHit found;
  found.range_m = static_cast<float>(hit.range_m);
  found.reflectivity = material.lidar_reflectivity;
  found.cos_incidence = std::abs(hit.normal_in_world.dot(ray.direction.cast<float>()));
  found.normal = hit.normal_in_world;
  return found;
}

LidarHit LidarCaster::cast(const HeadRay& ray, std::int64_t time_ps) const {
  const Ray in_world = this->in_world(ray, per_ps_ * static_cast<double>(time_ps - begin_ps_));
  const double time_s = 1e-9 * static_cast<double>(start_ns_) + 1e-12 * static_cast<double>(time_ps);
  const RayHit hit = window_.cast(in_world.origin, in_world.direction, 0.0, max_range_m_, time_s);
  LidarHit found;
  if (hit.hit) found = hit_on(surroundings_.world, hit, in_world);
  if (own_body_) {
    const Ray in_vehicle{vehicle_from_head_ * ray.origin_in_head + vehicle_from_lidar_.translation,
                         vehicle_from_head_ * ray.direction_in_head};
    const double nearest_m = hit.hit ? hit.range_m : max_range_m_;
    const RayHit own = own_body_->rays.cast(in_vehicle.origin, in_vehicle.direction, 0.0, nearest_m);
    if (own.hit) {
      found = hit_on(own_body_->world, own, in_vehicle);
      const Eigen::Matrix3d world_from_vehicle = rotation_ * vehicle_from_head_.transpose();
      found.normal = (world_from_vehicle * own.normal_in_world.cast<double>()).cast<float>();
    }
  }
  if (!found.is_none())
    found.point = (in_world.origin - place_ + double{found.range_m} * in_world.direction).cast<float>();
  return found;
}

}  // namespace plumbline
