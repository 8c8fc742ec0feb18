#include "sim/scenes/road_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

double direction_of(const Eigen::Vector3d& along) { return std::atan2(along.y(), along.x()); }

/// Headings at the samples by central differences, without jumps of a turn.
std::vector<double> headings_along(const std::vector<Eigen::Vector3d>& samples, bool closed) {
  const std::size_t count = samples.size();
  std::vector<double> headings;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i > 0 ? i - 1 : (closed ? count - 1 : 0);
    const std::size_t after = i + 1 < count ? i + 1 : (closed ? 0 : i);
    double heading = direction_of(samples[after] - samples[before]);
    if (!headings.empty())
      heading += 2.0 * std::numbers::pi * std::round((headings.back() - heading) / (2.0 * std::numbers::pi));
    headings.push_back(heading);
  }
  return headings;
}

/// Mean over a window of `width` samples, centred.
std::vector<double> smoothed(const std::vector<double>& values, int width) {
  std::vector<double> sums{0.0};
  for (const double value : values) sums.push_back(sums.back() + value);
  std::vector<double> means;
  const auto count = static_cast<int>(values.size());
  for (int i = 0; i < count; ++i) {
    const int low = std::max(0, i - width / 2);
    const int high = std::min(count, i + width / 2 + 1);
    means.push_back((sums[static_cast<std::size_t>(high)] - sums[static_cast<std::size_t>(low)]) / (high - low));
  }
  return means;
}

std::vector<double> random_curvatures(const Winding& plan, RandomStream& stream) {
  std::vector<double> curvatures;
  double heading = 0.0;
  const double enough = plan.length_m + 2.0 * plan.easing_m;
  while (static_cast<double>(curvatures.size()) < enough) {
    const auto straight = static_cast<std::size_t>(stream.uniform(plan.shortest_straight_m, plan.longest_straight_m));
    curvatures.insert(curvatures.end(), straight, 0.0);
    const double radius = stream.uniform(plan.min_radius_m, plan.max_radius_m);
    // The new heading lies well on the other side, or anywhere.
    double target = stream.uniform(-1.0, 1.0) * plan.heading_limit;
    if (target * heading > 0.0 && stream.uniform() < 0.6) target = -target;
    const double turn = target - heading;
    const auto bend = static_cast<std::size_t>(std::abs(turn) * radius);
    if (bend == 0) continue;
    curvatures.insert(curvatures.end(), bend, turn / static_cast<double>(bend));
    heading = target;
  }
  return curvatures;
}

/// Points `spacing` apart along a polyline.
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& points, std::size_t count) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) along.push_back(along.back() + (points[i] - points[i - 1]).norm());
  std::vector<Eigen::Vector2d> out;
  std::size_t cell = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = along.back() * static_cast<double>(i) / static_cast<double>(count);
    while (along[cell + 1] < s) ++cell;
    const double ratio = (s - along[cell]) / (along[cell + 1] - along[cell]);
    out.emplace_back(points[cell] + ratio * (points[cell + 1] - points[cell]));
  }
  return out;
}

/// The arc that rounds a corner, as points.
void add_rounded_corner(std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& before,
                        const Eigen::Vector2d& corner, const Eigen::Vector2d& after, double radius) {
  const Eigen::Vector2d in = (corner - before).normalized();
  const Eigen::Vector2d out = (after - corner).normalized();
  const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
  const double reach = radius * std::tan(0.5 * std::abs(turn));
  const Eigen::Vector2d left(-in.y(), in.x());
  const Eigen::Vector2d centre = corner - reach * in + std::copysign(radius, turn) * left;
  constexpr int kSteps = 48;
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Rotation2Dd rotation(turn * i / kSteps);
    points.emplace_back(centre + rotation * (corner - reach * in - centre));
  }
}

}  // namespace

RoadLine::RoadLine(std::vector<Eigen::Vector3d> samples, bool closed)
    : samples_(std::move(samples)),
      headings_(headings_along(samples_, closed)),
      length_(static_cast<double>(closed ? samples_.size() : samples_.size() - 1)),
      closed_(closed) {
  if (!closed_) return;
  samples_.push_back(samples_.front());
  const double turns = std::round((headings_.back() - headings_.front()) / (2.0 * std::numbers::pi));
  headings_.push_back(headings_.front() + 2.0 * std::numbers::pi * turns);
}

std::pair<std::size_t, double> RoadLine::cell(double s) const {
  if (closed_) s -= std::floor(s / length_) * length_;
  s = std::clamp(s, 0.0, length_);
  const auto index = std::min(static_cast<std::size_t>(s), samples_.size() - 2);
  return {index, s - static_cast<double>(index)};
}

Eigen::Vector3d RoadLine::at(double s) const {
  const auto [i, ratio] = cell(s);
  return samples_[i] + ratio * (samples_[i + 1] - samples_[i]);
}

double RoadLine::heading(double s) const {
  const auto [i, ratio] = cell(s);
  return headings_[i] + ratio * (headings_[i + 1] - headings_[i]);
}

Eigen::Vector3d RoadLine::place(double s, double n, double up) const {
  const double angle = heading(s);
  return at(s) + Eigen::Vector3d(-n * std::sin(angle), n * std::cos(angle), up);
}

Pose RoadLine::frame(double s, double n, double up, double yaw) const {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(heading(s) + yaw, Eigen::Vector3d::UnitZ())), place(s, n, up)};
}

RoadLine winding_line(const Winding& plan, RandomStream stream, const std::function<double(double s)>& height) {
  const std::vector<double> curvatures =
      smoothed(random_curvatures(plan, stream), static_cast<int>(std::lround(plan.easing_m)));
  std::vector<Eigen::Vector3d> samples;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double heading = 0.0;
  const auto count = static_cast<std::size_t>(std::ceil(plan.length_m)) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    samples.emplace_back(place.x(), place.y(), height(static_cast<double>(i)));
    heading += 0.5 * curvatures[i];
    place += Eigen::Vector2d(std::cos(heading), std::sin(heading));
    heading += 0.5 * curvatures[i];
  }
  return {std::move(samples), false};
}

RoadLine closed_line(std::vector<Eigen::Vector2d> corners, double radius_m, double length_m,
                     const std::function<double(const Eigen::Vector2d&)>& height) {
  const auto rounded = [&](double radius) {
    std::vector<Eigen::Vector2d> points;
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      add_rounded_corner(points, corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count], radius);
    }
    points.push_back(points.front());
    return points;
  };
  const auto length_of = [](const std::vector<Eigen::Vector2d>& points) {
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return length;
  };
  // Scaling the corners at a constant radius changes the length almost in proportion.
  for (int pass = 0; pass < 12; ++pass) {
    const double factor = length_m / length_of(rounded(radius_m));
    for (Eigen::Vector2d& corner : corners) corner *= factor;
  }
  std::vector<Eigen::Vector3d> samples;
  for (const Eigen::Vector2d& place : resampled(rounded(radius_m), static_cast<std::size_t>(std::lround(length_m)))) {
    samples.emplace_back(place.x(), place.y(), height(place));
  }
  return {std::move(samples), true};
}

Route route_beside(const RoadLine& line, const std::string& name, double from_s, double to_s, double n,
                   const std::function<double(double s)>& height_above, double spacing_m) {
  Route route;
  route.name = name;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(to_s - from_s) / spacing_m)));
  for (int i = 0; i <= steps; ++i) {
    const double s = from_s + (to_s - from_s) * i / steps;
    route.points.push_back(line.place(s, n, height_above(s)));
  }
  return route;
}

}  // namespace plumbline
