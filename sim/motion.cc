#include "sim/motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/random_stream.h"
#include "sim/tum_file.h"

namespace plumbline {
namespace {

constexpr double kStep_s = 0.01;   // knots of the trajectory; every IMU rate's interval falls between two of them
constexpr double kGrid_m = 0.005;  // of the speed profile along the path
constexpr double kGravity = 9.81;
constexpr double kDegree = M_PI / 180.0;
constexpr int kSmoothingPasses = 4;  // box filters; four make a kernel with three continuous derivatives
constexpr double kMaxDuration_s = 20000.0;
constexpr auto kMaxKnots = static_cast<std::size_t>(kMaxDuration_s / kStep_s);

/// Path length at every knot: from rest to rest, the waypoints' speeds, no more than the acceleration allowed.
std::vector<double> travel(const std::vector<double>& segment_end_m, const std::vector<double>& segment_mps,
                           double acceleration_mps2) {
  const auto count = static_cast<std::size_t>(std::ceil(segment_end_m.back() / kGrid_m)) + 1;
  std::vector<double> speed(count);
  std::size_t segment = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (segment + 1 < segment_end_m.size() && static_cast<double>(i) * kGrid_m > segment_end_m[segment]) ++segment;
    speed[i] = segment_mps[segment];
  }
  speed.front() = speed.back() = 0.0;
  const double gain = 2.0 * acceleration_mps2 * kGrid_m;
  for (std::size_t i = 1; i < count; ++i) speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + gain));
  for (std::size_t i = count - 1; i-- > 0;) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + gain));
  }
  std::vector<double> at_knot{0.0};
  double time = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    const double dt = 2.0 * kGrid_m / (speed[i - 1] + speed[i]);
    while (static_cast<double>(at_knot.size()) * kStep_s <= time + dt) {
      const double ratio = (static_cast<double>(at_knot.size()) * kStep_s - time) / dt;
      at_knot.push_back((static_cast<double>(i - 1) + ratio) * kGrid_m);
      if (at_knot.size() > kMaxKnots) throw std::invalid_argument("motion: longer than 20000 s");
    }
    time += dt;
  }
  at_knot.push_back(segment_end_m.back());
  return at_knot;
}

/// Repeated centred box filters. The result stays within the input's convex hull; the ends are held.
template <typename T>
std::vector<T> smoothed(std::vector<T> values, double total_width_s) {
  const auto half = static_cast<std::ptrdiff_t>(total_width_s / kSmoothingPasses / kStep_s / 2.0);
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](const std::vector<T>& v, std::ptrdiff_t i) {
    return v[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    std::vector<T> next(values);
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      T sum = at(values, i);
      for (std::ptrdiff_t k = 1; k <= half; ++k) sum += at(values, i - k) + at(values, i + k);
      next[static_cast<std::size_t>(i)] = sum / static_cast<double>(2 * half + 1);
    }
    values = std::move(next);
  }
  return values;
}

struct Course {
  std::vector<Eigen::Vector3d> position;
  std::vector<double> yaw;
  std::vector<double> effort;  ///< 0 at rest, 1 at full speed: how strongly gait and oscillations show
};

double unwrapped(double angle, double near) { return angle + 2.0 * M_PI * std::round((near - angle) / (2.0 * M_PI)); }

/// The way along the straight legs between way-points, with a heading that jumps from leg to leg.
Course sharp_course(const MotionConfig& config) {
  std::vector<double> end_m;
  std::vector<double> leg_mps;
  std::vector<double> leg_yaw;
  for (std::size_t i = 1; i < config.waypoints.size(); ++i) {
    const Eigen::Vector3d leg = config.waypoints[i].position - config.waypoints[i - 1].position;
    const double own = config.waypoints[i - 1].speed_mps;
    end_m.push_back((end_m.empty() ? 0.0 : end_m.back()) + leg.norm());
    leg_mps.push_back((own > 0.0 ? own : config.speed_mps) * config.speed_factor);
    const double near = leg_yaw.empty() ? 0.0 : leg_yaw.back();
    const bool vertical = leg.head<2>().norm() < 1e-6;
    leg_yaw.push_back(vertical ? near : unwrapped(std::atan2(leg.y(), leg.x()), near));
  }
  const double acceleration = config.acceleration_mps2 * config.speed_factor * config.speed_factor;
  // The smoothing reaches this far ahead; moving starts only after it, so that the rest is a true rest.
  const auto rest = static_cast<std::size_t>((config.rest_s + config.smoothing_s) / kStep_s) + 1;
  std::vector<double> s(rest, 0.0);
  const std::vector<double> moving = travel(end_m, leg_mps, acceleration);
  s.insert(s.end(), moving.begin(), moving.end());
  s.insert(s.end(), static_cast<std::size_t>(config.smoothing_s / kStep_s) + 1, end_m.back());

  Course course;
  const double top_mps = *std::max_element(leg_mps.begin(), leg_mps.end());
  std::size_t leg = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    while (leg + 1 < end_m.size() && s[i] > end_m[leg]) ++leg;
    const double begin = leg == 0 ? 0.0 : end_m[leg - 1];
    const double ratio = (s[i] - begin) / (end_m[leg] - begin);
    course.position.push_back(config.waypoints[leg].position +
                              ratio * (config.waypoints[leg + 1].position - config.waypoints[leg].position));
    course.yaw.push_back(leg_yaw[leg]);
    course.effort.push_back(i == 0 ? 0.0 : (s[i] - s[i - 1]) / kStep_s / top_mps);
  }
  return course;
}

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
  return (p[i + 1] - 2.0 * p[i] + p[i - 1]) / (kStep_s * kStep_s);
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

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("motion: " + message);
}

void validate_or_throw(const MotionConfig& c) {
  require(c.waypoints.size() >= 2, "waypoints: at least 2 are needed");
  for (std::size_t i = 1; i < c.waypoints.size(); ++i) {
    require((c.waypoints[i].position - c.waypoints[i - 1].position).norm() > 0.01,
            "waypoints: number " + std::to_string(i + 1) + " stands on the one before it");
  }
  require(c.speed_mps > 0.0 && c.speed_factor > 0.0, "speed_mps and speed_factor must be above 0");
  require(c.acceleration_mps2 > 0.0, "acceleration_mps2 must be above 0");
  require(c.smoothing_s >= 0.1, "smoothing_s must be at least 0.1");
}

Trajectory through_waypoints(const MotionConfig& config, std::uint64_t seed) {
  validate_or_throw(config);
  const Course sharp = sharp_course(config);
  const Course course{smoothed(sharp.position, config.smoothing_s), smoothed(sharp.yaw, config.smoothing_s),
                      smoothed(sharp.effort, config.smoothing_s)};
  RandomStream stream(seed, "gait");
  const Gait gait{stream.uniform(0.0, 2.0 * M_PI)};
  std::vector<PoseTrack::Stamped> poses;
  for (std::size_t i = 0; i < course.position.size(); ++i) {
    const double t = static_cast<double>(i) * kStep_s;
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
    poses.push_back({static_cast<std::int64_t>(i) * static_cast<std::int64_t>(kStep_s * 1e9), pose});
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
  if (seconds_between(0, last_ns) > kMaxDuration_s) throw std::invalid_argument(name + ": longer than 20000 s");
  return Trajectory(poses);
}

}  // namespace

Trajectory make_trajectory(const MotionConfig& config, const World& /*world*/, const RayScene& /*rays*/,
                           std::uint64_t seed) {
  return make_trajectory(config, seed);
}

Trajectory make_trajectory(const MotionConfig& config, std::uint64_t seed) {
  return config.tum_file.empty() ? through_waypoints(config, seed) : from_tum(config);
}

}  // namespace plumbline
