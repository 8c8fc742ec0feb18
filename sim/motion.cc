#include "sim/motion.h"

#include <cmath>
#include <stdexcept>

#include "sim/constants.h"
#include "sim/course.h"
#include "sim/random_stream.h"
#include "sim/tum_file.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {
namespace {

/// Body attitude of a rotor craft: z along the thrust that the path's acceleration needs, x towards the heading.
Eigen::Quaterniond thrust_attitude(const Eigen::Vector3d& acceleration, double yaw) {
  const Eigen::Vector3d z = (acceleration + kGravity * Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d heading(std::cos(yaw), std::sin(yaw), 0.0);
  const Eigen::Vector3d y = z.cross(heading).normalized();
  Eigen::Matrix3d r;
  r << y.cross(z), y, z;
  return Eigen::Quaterniond(r);
}

Eigen::Vector3d acceleration_at(const std::vector<Eigen::Vector3d>& p, std::size_t i) {
  if (i == 0 || i + 1 >= p.size()) return Eigen::Vector3d::Zero();
  return (p[i + 1] - 2.0 * p[i] + p[i - 1]) / (Course::kStep_s * Course::kStep_s);
}

/// A walker's bob and sway: up and down with every step, left and right with every second one.
struct Gait {
  double step_phase = 0.0;
  Eigen::Vector3d offset(const MotionConfig& c, double t, double yaw, double effort) const {
    const double step = 2.0 * M_PI * c.gait_frequency_hz * t + step_phase;
    const double sway = c.gait_sway_m * std::sin(0.5 * step) * effort;
    return {-std::sin(yaw) * sway, std::cos(yaw) * sway, c.gait_height_m * std::sin(step) * effort};
  }
  Eigen::Vector3d tilt(const MotionConfig& c, double t, double effort) const {
    const double step = 2.0 * M_PI * c.gait_frequency_hz * t + step_phase;
    return Eigen::Vector3d(c.gait_roll_deg * std::cos(0.5 * step), c.gait_pitch_deg * std::cos(step), 0.0) * kDegree *
           effort;
  }
};

Eigen::Vector3d swing(const std::vector<Oscillation>& oscillations, double t, double effort) {
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  for (const auto& o : oscillations) {
    rpy[static_cast<int>(o.axis)] += o.amplitude_deg * kDegree * std::sin(2.0 * M_PI * o.frequency_hz * t) * effort;
  }
  return rpy;
}

Trajectory along(const Course& course, const MotionConfig& config, std::uint64_t seed) {
  RandomStream stream(seed, "gait");
  const Gait gait{stream.uniform(0.0, 2.0 * M_PI)};
  std::vector<PoseTrack::Stamped> poses;
  for (std::size_t i = 0; i < course.position.size(); ++i) {
    const double t = static_cast<double>(i) * Course::kStep_s;
    const double effort = course.effort[i];
    Eigen::Quaterniond attitude = rotation_from_rpy({0.0, 0.0, course.yaw[i]});
    if (config.attitude == MotionConfig::Attitude::kThrust) {
      attitude = thrust_attitude(acceleration_at(course.position, i), course.yaw[i]);
    }
    Pose pose{attitude * rotation_from_rpy(swing(config.oscillations, t, effort)), course.position[i]};
    if (config.gait_frequency_hz > 0.0) {
      pose.translation += gait.offset(config, t, course.yaw[i], effort);
      pose.rotation = pose.rotation * rotation_from_rpy(gait.tilt(config, t, effort));
    }
    poses.push_back({static_cast<std::int64_t>(i) * static_cast<std::int64_t>(Course::kStep_s * 1e9), pose});
  }
  return Trajectory(poses);
}

Trajectory from_tum(const MotionConfig& config) {
  std::vector<PoseTrack::Stamped> poses = read_tum_file(config.tum_file);
  const std::string name = config.tum_file.string();
  if (poses.size() < 4) throw std::invalid_argument(name + ": fewer than 4 poses make no smooth motion");
  const std::int64_t start_ns = poses.front().stamp_ns;
  std::int64_t last_ns = -1;
  for (PoseTrack::Stamped& stamped : poses) {
    const double offset_ns = static_cast<double>(stamped.stamp_ns - start_ns) / config.speed_factor;
    stamped.stamp_ns = std::llround(offset_ns);
    if (stamped.stamp_ns <= last_ns) throw std::invalid_argument(name + ": speed_factor is too large for its stamps");
    last_ns = stamped.stamp_ns;
  }
  if (seconds_between(0, last_ns) > kLongestMotion_s) throw std::invalid_argument(name + ": longer than 20000 s");
  return Trajectory(poses);
}

}  // namespace

void require_of_motion(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("motion: " + message);
}

Trajectory make_trajectory(const MotionConfig& config, const World& world, const RayScene& rays, std::uint64_t seed) {
  if (!config.tum_file.empty()) return from_tum(config);
  if (!config.vehicle.empty()) return vehicle_named(config.vehicle).drive(config, world, rays, seed);
  return along(course_of(config, world), config, seed);
}

Trajectory make_trajectory(const MotionConfig& config, std::uint64_t seed) {
  if (!config.tum_file.empty()) return from_tum(config);
  if (!config.vehicle.empty() || !config.route.empty()) {
    throw std::invalid_argument("motion: vehicles and routes need a world");
  }
  return along(course_through_waypoints(config), config, seed);
}

}  // namespace plumbline
