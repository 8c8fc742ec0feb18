#include "sim/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/box_smoothing.h"

namespace plumbline {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// One leg of a centripetal Catmull-Rom curve (Barry and Goldman's pyramid), from p[1] to p[2]; ratio in [0, 1].
Eigen::Vector3d catmull_rom(const std::array<Eigen::Vector3d, 4>& p, double ratio) {
  std::array<double, 4> t{};
  for (std::size_t i = 1; i < 4; ++i) t[i] = t[i - 1] + std::sqrt((p[i] - p[i - 1]).norm());
  const double now = t[1] + ratio * (t[2] - t[1]);
  const auto blend = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::size_t i, std::size_t j) {
    return Eigen::Vector3d(((t[j] - now) * a + (now - t[i]) * b) / (t[j] - t[i]));
  };
  const Eigen::Vector3d a = blend(p[0], p[1], 0, 1);
  const Eigen::Vector3d b = blend(p[1], p[2], 1, 2);
  const Eigen::Vector3d c = blend(p[2], p[3], 2, 3);
  return blend(blend(a, b, 0, 2), blend(b, c, 1, 3), 1, 2);
}

Points curve_through(const Points& points) {
  Points curve;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Eigen::Vector3d before = i > 0 ? points[i - 1] : Eigen::Vector3d(2.0 * points[0] - points[1]);
    const Eigen::Vector3d after = i + 2 < n ? points[i + 2] : Eigen::Vector3d(2.0 * points[n - 1] - points[n - 2]);
    const int pieces = std::max(1, static_cast<int>(std::ceil((points[i + 1] - points[i]).norm() / Path::kStep_m)));
    for (int k = 0; k < pieces; ++k) {
      curve.push_back(catmull_rom({before, points[i], points[i + 1], after}, static_cast<double>(k) / pieces));
    }
  }
  curve.push_back(points.back());
  return curve;
}

double length_of(const Points& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

/// Points the same distance apart along the polyline, its ends included.
Points evenly_spaced(const Points& points) {
  const double length = length_of(points);
  const auto pieces = static_cast<std::size_t>(std::max(4.0, std::ceil(length / Path::kStep_m)));
  const double step = length / static_cast<double>(pieces);
  Points even{points.front()};
  double begin = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double leg = (points[i] - points[i - 1]).norm();
    while (even.size() < pieces && static_cast<double>(even.size()) * step <= begin + leg) {
      const double ratio = (static_cast<double>(even.size()) * step - begin) / leg;
      even.emplace_back(points[i - 1] + ratio * (points[i] - points[i - 1]));
    }
    begin += leg;
  }
  even.push_back(points.back());
  return even;
}

/// A moving average that leaves the ends where they are: the curve goes on beyond them, turned by half a turn.
Points rounded(const Points& even, double smoothing_m) {
  constexpr int kPasses = 4;
  const auto half = static_cast<std::ptrdiff_t>(smoothing_m / kPasses / Path::kStep_m / 2.0);
  const std::ptrdiff_t reach = kPasses * half;
  const auto last = static_cast<std::ptrdiff_t>(even.size()) - 1;
  const auto mirrored = [&](std::ptrdiff_t i) -> Eigen::Vector3d {
    if (i < 0) return 2.0 * even.front() - even[static_cast<std::size_t>(std::min(-i, last))];
    if (i > last) return 2.0 * even.back() - even[static_cast<std::size_t>(std::max<std::ptrdiff_t>(2 * last - i, 0))];
    return even[static_cast<std::size_t>(i)];
  };
  Points longer;
  for (std::ptrdiff_t i = -reach; i <= last + reach; ++i) longer.push_back(mirrored(i));
  longer = box_smoothed(std::move(longer), half, kPasses);
  return {longer.begin() + reach, longer.end() - reach};
}

std::string metres(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2) + " m";
}

const Route& route_named(const std::string& name, const World& world) {
  const std::vector<Route>& routes = world.routes();
  require_of_motion(!routes.empty(), "route: this world has no routes; give way-points");
  std::string known;
  for (const Route& route : routes) {
    if (route.name == name) return route;
    known += (known.empty() ? "" : ", ") + route.name;
  }
  require_of_motion(name == "tour", "route: found '" + name + "', this world has " + known);
  return routes.front();
}

/// The polyline from `from_m` to `to_m` along `points`.
Points cut_out(const Points& points, double from_m, double to_m) {
  constexpr double kApart_m = 0.01;
  Points part;
  const auto add = [&](const Eigen::Vector3d& point) {
    if (part.empty() || (point - part.back()).norm() > kApart_m) part.push_back(point);
  };
  double begin = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double leg = (points[i] - points[i - 1]).norm();
    const double end = begin + leg;
    if (end >= from_m && begin <= to_m && leg > 0.0) {
      const Eigen::Vector3d along = (points[i] - points[i - 1]) / leg;
      add(points[i - 1] + along * std::clamp(from_m - begin, 0.0, leg));
      add(points[i - 1] + along * std::clamp(to_m - begin, 0.0, leg));
    }
    begin = end;
  }
  return part;
}

Points part_of_route(const MotionConfig& config, const Route& route) {
  Points points = route.points;
  if (route.closed) points.push_back(route.points.front());
  const double round_m = length_of(points);
  require_of_motion(
      config.route_start_m >= 0.0 && config.route_start_m < round_m,
      "route_start_m: found " + metres(config.route_start_m) + ", the route is " + metres(round_m) + " long");
  const double rest_m = route.closed ? round_m : round_m - config.route_start_m;
  const double wanted_m = config.route_length_m > 0.0 ? config.route_length_m : rest_m;
  require_of_motion(route.closed || wanted_m <= rest_m + 1e-6, "route_length_m: found " + metres(wanted_m) +
                                                                   ", the route goes on for " + metres(rest_m) +
                                                                   " from route_start_m");
  const auto rounds = static_cast<int>(std::ceil((config.route_start_m + wanted_m) / round_m));
  Points all = points;
  for (int i = 1; i < rounds; ++i) all.insert(all.end(), points.begin() + 1, points.end());
  return cut_out(all, config.route_start_m, config.route_start_m + wanted_m);
}

}  // namespace

Path::Path(const std::vector<Eigen::Vector3d>& points, double smoothing_m) {
  require_of_motion(points.size() >= 2, "a path needs at least 2 points");
  for (std::size_t i = 1; i < points.size(); ++i) {
    require_of_motion((points[i] - points[i - 1]).norm() >= 0.0099,
                      "a path's points: number " + std::to_string(i + 1) + " stands on the one before it");
  }
  control_ = evenly_spaced(rounded(evenly_spaced(curve_through(points)), smoothing_m));
  length_m_ = length_of(control_);
  step_m_ = length_m_ / static_cast<double>(control_.size() - 1);
}

PathPoint Path::at(double along_m) const {
  const auto last = static_cast<std::ptrdiff_t>(control_.size()) - 1;
  const double place = std::clamp(along_m / step_m_, 0.0, static_cast<double>(last));
  const auto i = std::min(static_cast<std::ptrdiff_t>(place), last - 1);
  const double u = place - static_cast<double>(i);
  const auto control = [&](std::ptrdiff_t k) -> Eigen::Vector3d {
    if (k < 0) return 2.0 * control_.front() - control_[1];
    if (k > last) return 2.0 * control_.back() - control_[static_cast<std::size_t>(last - 1)];
    return control_[static_cast<std::size_t>(k)];
  };
  const Eigen::Vector3d a = control(i - 1);
  const Eigen::Vector3d b = control(i);
  const Eigen::Vector3d c = control(i + 1);
  const Eigen::Vector3d d = control(i + 2);
  // The uniform cubic B-spline and its derivatives.
  const double v = 1.0 - u;
  PathPoint point;
  point.position = (v * v * v * a + (3.0 * u * u * u - 6.0 * u * u + 4.0) * b +
                    (3.0 * v * v * v - 6.0 * v * v + 4.0) * c + u * u * u * d) /
                   6.0;
  point.tangent = (v * v * (b - a) + (1.0 + 2.0 * u * v) * (c - b) + u * u * (d - c)) / (2.0 * step_m_);
  point.curvature = (v * (a - 2.0 * b + c) + u * (b - 2.0 * c + d)) / (step_m_ * step_m_);
  return point;
}

double Path::nearest(const Eigen::Vector3d& place, double near_m) const {
  double along_m = std::clamp(near_m, 0.0, length_m_);
  for (int i = 0; i < 4; ++i) {
    const PathPoint point = at(along_m);
    const Eigen::Vector2d tangent = point.tangent.head<2>();
    const double ahead = tangent.dot((place - point.position).head<2>());
    along_m = std::clamp(along_m + ahead / std::max(tangent.squaredNorm(), 0.1), 0.0, length_m_);
  }
  return along_m;
}

std::vector<Eigen::Vector3d> points_of(const MotionConfig& config, const World& world) {
  if (!config.route.empty()) return part_of_route(config, route_named(config.route, world));
  require_of_motion(config.waypoints.size() >= 2, "waypoints: at least 2 are needed");
  Points points;
  for (const MotionConfig::Waypoint& waypoint : config.waypoints) points.push_back(waypoint.position);
  for (std::size_t i = 1; i < points.size(); ++i) {
    require_of_motion((points[i] - points[i - 1]).norm() > 0.01,
                      "waypoints: number " + std::to_string(i + 1) + " stands on the one before it");
  }
  return points;
}

}  // namespace plumbline
