#include "sim/course.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "sim/box_smoothing.h"

namespace plumbline {
namespace {

constexpr double kStep_s = Course::kStep_s;
constexpr double kGrid_m = 0.005;  // of the speed profile along the path
constexpr int kSmoothingPasses = 4;
constexpr auto kMaxKnots = static_cast<std::size_t>(kLongestMotion_s / kStep_s);

void validate_or_throw(const MotionConfig& c) {
  require_of_motion(c.speed_mps > 0.0 && c.speed_factor > 0.0, "speed_mps and speed_factor must be above 0");
  require_of_motion(c.acceleration_mps2 > 0.0, "acceleration_mps2 must be above 0");
  require_of_motion(c.lateral_acceleration_mps2 > 0.0, "lateral_acceleration_mps2 must be above 0");
  require_of_motion(c.smoothing_s >= 0.1, "smoothing_s must be at least 0.1");
}

/// Path length at every knot: from rest to rest, no faster than the limit, no more than the acceleration allowed.
std::vector<double> travel(double length_m, const std::function<double(double)>& limit_mps, double acceleration_mps2) {
  const auto count = static_cast<std::size_t>(std::ceil(length_m / kGrid_m)) + 1;
  std::vector<double> speed(count);
  for (std::size_t i = 0; i < count; ++i) speed[i] = limit_mps(static_cast<double>(i) * kGrid_m);
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
      require_of_motion(at_knot.size() <= kMaxKnots, "longer than 20000 s");
    }
    time += dt;
  }
  at_knot.push_back(length_m);
  return at_knot;
}

template <typename T>
std::vector<T> smoothed(std::vector<T> values, double total_width_s) {
  return box_smoothed(std::move(values), static_cast<std::ptrdiff_t>(total_width_s / kSmoothingPasses / kStep_s / 2.0),
                      kSmoothingPasses);
}

double unwrapped(double angle, double near) { return angle + 2.0 * M_PI * std::round((near - angle) / (2.0 * M_PI)); }

double first_heading(const Path& path, const std::vector<double>& along_m, double least_level) {
  for (const double s : along_m) {
    const PathPoint point = path.at(s);
    if (point.tangent.head<2>().norm() >= least_level) return point.heading();
  }
  return 0.0;
}

double acceleration_of(const MotionConfig& config) {
  return config.acceleration_mps2 * config.speed_factor * config.speed_factor;
}

double route_speed(const MotionConfig& config, double along_m) {
  double speed_mps = config.speed_mps;
  for (const MotionConfig::Stretch& stretch : config.route_speeds) {
    if (along_m >= stretch.from_m) speed_mps = stretch.speed_mps;
  }
  return speed_mps;
}

double top_route_speed(const MotionConfig& config) {
  double top_mps = config.speed_mps;
  for (const MotionConfig::Stretch& stretch : config.route_speeds) top_mps = std::max(top_mps, stretch.speed_mps);
  return top_mps;
}

/// The straight legs between way-points: where each ends, its speed and its heading.
struct Legs {
  std::vector<double> end_m;
  std::vector<double> mps;
  std::vector<double> yaw;

  /// The leg at a distance, not before `leg`.
  std::size_t at(double along_m, std::size_t leg) const {
    while (leg + 1 < end_m.size() && along_m > end_m[leg]) ++leg;
    return leg;
  }
};

Legs legs_of(const MotionConfig& config) {
  Legs legs;
  for (std::size_t i = 1; i < config.waypoints.size(); ++i) {
    const Eigen::Vector3d leg = config.waypoints[i].position - config.waypoints[i - 1].position;
    const double own = config.waypoints[i - 1].speed_mps;
    legs.end_m.push_back((legs.end_m.empty() ? 0.0 : legs.end_m.back()) + leg.norm());
    legs.mps.push_back((own > 0.0 ? own : config.speed_mps) * config.speed_factor);
    const double near = legs.yaw.empty() ? 0.0 : legs.yaw.back();
    const bool vertical = leg.head<2>().norm() < 1e-6;
    legs.yaw.push_back(vertical ? near : unwrapped(std::atan2(leg.y(), leg.x()), near));
  }
  return legs;
}

/// A rest before and after. The smoothing reaches its width ahead; moving starts only after it, so that the rest is a
/// true rest.
std::vector<double> with_rests(const std::vector<double>& moving, const MotionConfig& config) {
  std::vector<double> s(static_cast<std::size_t>((config.rest_s + config.smoothing_s) / kStep_s) + 1, 0.0);
  s.insert(s.end(), moving.begin(), moving.end());
  s.insert(s.end(), static_cast<std::size_t>(config.smoothing_s / kStep_s) + 1, moving.back());
  return s;
}

std::vector<double> efforts(const std::vector<double>& along_m, double top_mps) {
  std::vector<double> effort;
  for (std::size_t i = 0; i < along_m.size(); ++i) {
    effort.push_back(i == 0 ? 0.0 : (along_m[i] - along_m[i - 1]) / kStep_s / top_mps);
  }
  return effort;
}

/// The way along the straight legs between way-points, with a heading that jumps from leg to leg.
Course sharp_course(const MotionConfig& config) {
  const Legs legs = legs_of(config);
  std::size_t at_limit = 0;
  const auto limit = [&](double along_m) { return legs.mps[at_limit = legs.at(along_m, at_limit)]; };
  const std::vector<double> s = with_rests(travel(legs.end_m.back(), limit, acceleration_of(config)), config);
  Course course;
  std::size_t leg = 0;
  for (const double along_m : s) {
    leg = legs.at(along_m, leg);
    const double begin = leg == 0 ? 0.0 : legs.end_m[leg - 1];
    const double ratio = (along_m - begin) / (legs.end_m[leg] - begin);
    course.position.emplace_back(config.waypoints[leg].position +
                                 ratio * (config.waypoints[leg + 1].position - config.waypoints[leg].position));
    course.yaw.push_back(legs.yaw[leg]);
  }
  course.effort = efforts(s, *std::max_element(legs.mps.begin(), legs.mps.end()));
  return course;
}

}  // namespace

Course course_through_waypoints(const MotionConfig& config) {
  require_of_motion(config.waypoints.size() >= 2, "waypoints: at least 2 are needed");
  for (std::size_t i = 1; i < config.waypoints.size(); ++i) {
    require_of_motion((config.waypoints[i].position - config.waypoints[i - 1].position).norm() > 0.01,
                      "waypoints: number " + std::to_string(i + 1) + " stands on the one before it");
  }
  validate_or_throw(config);
  Course course = sharp_course(config);
  course.position = smoothed(std::move(course.position), config.smoothing_s);
  course.yaw = smoothed(std::move(course.yaw), config.smoothing_s);
  course.effort = smoothed(std::move(course.effort), config.smoothing_s);
  return course;
}

Course course_along(const Path& path, const MotionConfig& config, Turning turning) {
  validate_or_throw(config);
  const bool by_legs = config.route.empty();
  const Legs legs = by_legs ? legs_of(config) : Legs{};
  // Rounding shortens the legs a little; their speeds change at the same share of the way.
  const double leg_scale = by_legs ? legs.end_m.back() / path.length_m() : 1.0;
  const double lateral_mps2 = config.lateral_acceleration_mps2 * config.speed_factor * config.speed_factor;
  std::size_t leg = 0;
  const auto limit = [&](double along_m) {
    const double own = by_legs ? legs.mps[leg = legs.at(along_m * leg_scale, leg)]
                               : route_speed(config, along_m) * config.speed_factor;
    const PathPoint point = path.at(along_m);
    const double bend = turning == Turning::kInAir ? point.curvature.norm() : std::abs(point.turn());
    return std::min(own, std::sqrt(lateral_mps2 / std::max(bend, 1e-9)));
  };
  Course course;
  course.along_m =
      smoothed(with_rests(travel(path.length_m(), limit, acceleration_of(config)), config), config.smoothing_s);
  // A steep climb's bow to one side is no heading: a craft that rises from its pad already looks where it will go.
  const double least_level = turning == Turning::kInAir ? 0.3 : 1e-3;
  double yaw = first_heading(path, course.along_m, least_level);
  for (const double along_m : course.along_m) {
    const PathPoint point = path.at(along_m);
    course.position.push_back(point.position);
    if (point.tangent.head<2>().norm() >= least_level) yaw = unwrapped(point.heading(), yaw);
    course.yaw.push_back(yaw);
  }
  course.yaw = smoothed(std::move(course.yaw), config.smoothing_s);
  const double top_mps =
      by_legs ? *std::max_element(legs.mps.begin(), legs.mps.end()) : top_route_speed(config) * config.speed_factor;
  course.effort = efforts(course.along_m, top_mps);
  return course;
}

Course course_of(const MotionConfig& config, const World& world) {
  if (config.route.empty()) return course_through_waypoints(config);
  // As wide as the corners of way-points are rounded in time, but no wider than a lane allows.
  const double smoothing_m = std::clamp(config.speed_mps * config.smoothing_s, 1.0, 10.0);
  Course course = course_along(Path(points_of(config, world), smoothing_m), config, Turning::kOnGround);
  for (Eigen::Vector3d& position : course.position) position.z() += config.height_m;
  return course;
}

}  // namespace plumbline
