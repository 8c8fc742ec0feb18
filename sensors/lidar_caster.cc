#include "sensors/lidar_caster.h"

#include <algorithm>
#include <array>
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
      window_(surroundings.rays.window(place_, max_range_m, 1e-9 * static_cast<double>(start_ns))) {
  if (!own_body_) return;
  vehicle_from_lidar_ = own_body_->body_from_vehicle.inverse() * body_from_lidar_;
  own_window_ = own_body_->rays.window(vehicle_from_lidar_.translation, max_range_m_);
}

Pose LidarCaster::world_from_lidar(std::int64_t time_ps) const {
  return world_from_body_.at(start_ns_ + (time_ps + 500) / 1000) * body_from_lidar_;
}

HeadMotion LidarCaster::motion_of(const FiringPattern::Cycle& cycle) {
  HeadMotion motion;
  motion.begin_ps = std::max<std::int64_t>(cycle.offset_ps, 0);
  const Pose begin = motion.begin_ps == end_ps_ ? world_from_lidar_at_end_ : world_from_lidar(motion.begin_ps);
  end_ps_ = std::min(cycle.offset_ps + cycle_ps_, message_ps_);
  world_from_lidar_at_end_ = world_from_lidar(end_ps_);
  motion.per_ps = 1.0 / static_cast<double>(end_ps_ - motion.begin_ps);
  motion.rotation = begin.rotation.toRotationMatrix() * cycle.lidar_from_head;
  motion.rotation_change =
      world_from_lidar_at_end_.rotation.toRotationMatrix() * cycle.lidar_from_head - motion.rotation;
  motion.translation = begin.translation;
  motion.translation_change = world_from_lidar_at_end_.translation - begin.translation;
  if (own_body_) motion.vehicle_from_head = vehicle_from_lidar_.rotation.toRotationMatrix() * cycle.lidar_from_head;
  return motion;
}

LidarHit LidarCaster::hit_on(const World& world, const RayHit& hit, const Ray& ray) const {
  const Material& material = world.materials()[static_cast<std::size_t>(world.material_of(hit.geom))];
  LidarHit found;
  found.normal = hit.normal_in_world;
  found.range_m = static_cast<float>(hit.range_m);
  found.reflectivity = material.lidar_reflectivity;
  found.cos_incidence = std::abs(hit.normal_in_world.dot(ray.direction.cast<float>()));
  return found;
}

LidarHit LidarCaster::hit_on_vehicle(const HeadMotion& motion, const HeadRay& ray, double max_range_m) const {
  const Ray in_vehicle{motion.vehicle_from_head * ray.origin_in_head + vehicle_from_lidar_.translation,
                       motion.vehicle_from_head * ray.direction_in_head};
  const RayHit hit = own_window_->cast(in_vehicle.origin, in_vehicle.direction, 0.0, max_range_m, 0.0);
  if (!hit.hit) return {};
  LidarHit found = hit_on(own_body_->world, hit, in_vehicle);
  const Eigen::Matrix3d world_from_vehicle = motion.rotation * motion.vehicle_from_head.transpose();
  found.normal = (world_from_vehicle * hit.normal_in_world.cast<double>()).cast<float>();
  return found;
}

LidarCaster::Ray LidarCaster::in_world(const HeadMotion& motion, const HeadRay& ray, std::int64_t time_ps) const {
  const double ratio = motion.per_ps * static_cast<double>(time_ps - motion.begin_ps);
  const Eigen::Matrix3d rotation = motion.rotation + ratio * motion.rotation_change;
  return {rotation * ray.origin_in_head + motion.translation + ratio * motion.translation_change,
          rotation * ray.direction_in_head};
}

double LidarCaster::seconds(std::int64_t time_ps) const {
  return 1e-9 * static_cast<double>(start_ns_) + 1e-12 * static_cast<double>(time_ps);
}

LidarHit LidarCaster::first_hit(const HeadMotion& motion, const HeadRay& ray, const Ray& in_world,
                                const RayHit& hit) const {
  LidarHit found;
  if (hit.hit) {
    found = hit_on(surroundings_.world, hit, in_world);
    found.stands = surroundings_.world.mover_of(hit.geom) < 0;
  }
  if (own_body_) {
    const LidarHit own = hit_on_vehicle(motion, ray, hit.hit ? hit.range_m : max_range_m_);
    if (!own.is_none()) {
      found = own;
      found.is_own = true;
    }
  }
  if (!found.is_none())
    found.point = (in_world.origin - place_ + double{found.range_m} * in_world.direction).cast<float>();
  return found;
}

LidarHit LidarCaster::cast(const HeadMotion& motion, const HeadRay& ray, std::int64_t time_ps) const {
  const Ray cast_ray = in_world(motion, ray, time_ps);
  return first_hit(motion, ray, cast_ray,
                   window_.cast(cast_ray.origin, cast_ray.direction, 0.0, max_range_m_, seconds(time_ps)));
}

void LidarCaster::cast(std::span<const Shot> shots, std::span<LidarHit> hits) const {
  RayPacket rays;
  rays.size = shots.size();
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Ray ray = in_world(*shots[i].motion, shots[i].ray, shots[i].time_ps);
    rays.origins[i] = ray.origin;
    rays.directions[i] = ray.direction;
    rays.times_s[i] = seconds(shots[i].time_ps);
  }
  std::array<RayHit, RayPacket::kMost> found;
  window_.cast(rays, 0.0, max_range_m_, found);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    hits[i] = first_hit(*shots[i].motion, shots[i].ray, {rays.origins[i], rays.directions[i]}, found[i]);
  }
}

}  // namespace plumbline
