#include "sensors/lidar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace plumbline {
namespace {

constexpr double kReferenceReflectivity = 0.1;  // of LidarModel::range_at_10_percent_m

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

// Rank of each laser by elevation, from the lowest.
std::vector<std::uint16_t> rings_of(const std::vector<double>& elevation_deg) {
  std::vector<std::size_t> from_lowest(elevation_deg.size());
  std::iota(from_lowest.begin(), from_lowest.end(), std::size_t{0});
  std::stable_sort(from_lowest.begin(), from_lowest.end(),
                   [&](std::size_t a, std::size_t b) { return elevation_deg[a] < elevation_deg[b]; });
  std::vector<std::uint16_t> ring(elevation_deg.size());
  for (std::size_t rank = 0; rank < from_lowest.size(); ++rank)
    ring[from_lowest[rank]] = static_cast<std::uint16_t>(rank);
  return ring;
}

// Between the poses at both ends of a firing cycle. Over its 0.06 ms the normalised sum of the quaternions is the
// geodesic to within 1e-11 rad at 10 rad/s, and costs a tenth of it.
Pose pose_within_cycle(const Pose& begin, const Pose& end, double ratio) {
  const double toward_end = begin.rotation.dot(end.rotation) < 0.0 ? -ratio : ratio;
  const Eigen::Vector4d sum = (1.0 - ratio) * begin.rotation.coeffs() + toward_end * end.rotation.coeffs();
  return {Eigen::Quaterniond(sum).normalized(), (1.0 - ratio) * begin.translation + ratio * end.translation};
}

void require_cover(const PoseTrack& track, std::int64_t start_ns, std::int64_t end_ns) {
  if (track.covers(start_ns) && track.covers(end_ns)) return;
  throw std::invalid_argument(
      "lidar: the motion must cover the revolution from " + std::to_string(start_ns) + " to " + std::to_string(end_ns) +
      " ns, but " +
      (track.empty() ? "is empty"
                     : "spans " + std::to_string(track.first_ns()) + " to " + std::to_string(track.last_ns()) + " ns"));
}

}  // namespace

Lidar::Lidar(LidarModel model, const Pose& body_from_lidar, std::uint64_t seed)
    : model_(std::move(model)), body_from_lidar_(body_from_lidar), seed_(derive_seed(seed, "lidar")) {
  validate_or_throw(model_);
  RandomStream bias(seed_, "ring bias");
  const std::vector<std::uint16_t> rings = rings_of(model_.elevation_deg);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double elevation = radians(model_.elevation_deg[i]);
    lasers_.push_back({.cos_elevation = std::cos(elevation),
                       .sin_elevation = std::sin(elevation),
                       .vertical_offset_m = model_.vertical_offset_m[i],
                       .range_bias_m = model_.ring_bias_sigma_m * bias.gaussian(),
                       .share_of_cycle = model_.laser_offset_s[i] / model_.cycle_s,
                       .offset_ns = static_cast<std::int32_t>(nanoseconds(model_.laser_offset_s[i])),
                       .ring = rings[i]});
  }
}

std::int64_t Lidar::period_ns() const { return nanoseconds(1.0 / model_.rate_hz); }

LidarScan Lidar::scan(const Surroundings& surroundings, const PoseTrack& world_from_body, std::int64_t start_ns,
                      std::int64_t scan_index) const {
  LidarScan scan;
  scan.stamp_ns = start_ns;
  scan.end_ns = start_ns + period_ns();
  scan.sweep = scan_index;
  require_cover(world_from_body, scan.stamp_ns, scan.end_ns);
  // Whole cycles only: the head's remaining part of a cycle falls to nobody.
  const auto cycles = static_cast<int>(seconds_between(scan.stamp_ns, scan.end_ns) / model_.cycle_s);
  scan.points.reserve(static_cast<std::size_t>(cycles) * lasers_.size());
  RandomStream noise(seed_ + static_cast<std::uint64_t>(scan_index), "ranges");

  const auto pose_at_cycle = [&](int cycle) {
    return world_from_body.at(start_ns + nanoseconds(cycle * model_.cycle_s)) * body_from_lidar_;
  };
  Pose cycle_end = pose_at_cycle(0);
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const Pose cycle_begin = cycle_end;
    cycle_end = pose_at_cycle(cycle + 1);
    const auto cycle_offset_ns = static_cast<std::int32_t>(nanoseconds(cycle * model_.cycle_s));
    for (const Laser& laser : lasers_) {
      // Drawn whether or not there is a return, so that a surface's change leaves the others' noise as it was.
      const double range_noise_m = model_.range_sigma_m * noise.gaussian();
      const Pose world_from_lidar = pose_within_cycle(cycle_begin, cycle_end, laser.share_of_cycle);
      const auto point = fire(surroundings, world_from_lidar, laser, cycle_offset_ns + laser.offset_ns, range_noise_m);
      if (point) scan.points.push_back(*point);
    }
  }
  return scan;
}

std::optional<LidarPoint> Lidar::fire(const Surroundings& surroundings, const Pose& world_from_lidar,
                                      const Laser& laser, std::int32_t offset_ns, double range_noise_m) const {
  const double azimuth = std::numbers::pi * (1.0 - 2.0 * model_.rate_hz * 1e-9 * offset_ns);
  const Eigen::Vector3d origin(0.0, 0.0, laser.vertical_offset_m);
  const Eigen::Vector3d direction(laser.cos_elevation * std::cos(azimuth), laser.cos_elevation * std::sin(azimuth),
                                  laser.sin_elevation);
  const Eigen::Vector3d direction_in_world = world_from_lidar.rotation * direction;
  const RayHit hit = surroundings.rays.cast(world_from_lidar * origin, direction_in_world, 0.0, model_.max_range_m);
  if (!hit.hit) return std::nullopt;

  const Material& material =
      surroundings.world.materials()[static_cast<std::size_t>(surroundings.world.material_of(hit.geom))];
  const double cos_incidence = std::abs(hit.normal_in_world.cast<double>().dot(direction_in_world));
  const double reflectivity_towards_lidar = material.lidar_reflectivity * cos_incidence;
  if (!is_detected(hit.range_m, reflectivity_towards_lidar)) return std::nullopt;
  const double range = measured_range(hit.range_m, laser, range_noise_m);
  if (range < model_.min_range_m || range > model_.max_range_m) return std::nullopt;

  LidarPoint point;
  point.position = (origin + range * direction).cast<float>();
  point.offset_ns = offset_ns;
  point.ring = laser.ring;
  point.intensity = static_cast<float>(std::clamp(reflectivity_towards_lidar, 0.0, 1.0));
  return point;
}

double Lidar::measured_range(double true_range_m, const Laser& laser, double range_noise_m) const {
  if (!noise_enabled) return true_range_m;
  const double range = true_range_m + laser.range_bias_m + range_noise_m;
  const double resolution = model_.range_resolution_m;
  return resolution > 0.0 ? resolution * std::round(range / resolution) : range;
}

// The light received from an extended Lambertian target goes with reflectivity cos(incidence) / range^2 (Hoefle and
// Pfeifer, ISPRS J. 62(6), 2007, eq. 7, without the air's absorption); less than the data sheet's weakest target is
// lost.
bool Lidar::is_detected(double range_m, double reflectivity_towards_lidar) const {
  if (!noise_enabled) return true;
  const double relative_range = range_m / model_.range_at_10_percent_m;
  return reflectivity_towards_lidar >= kReferenceReflectivity * relative_range * relative_range;
}

}  // namespace plumbline
