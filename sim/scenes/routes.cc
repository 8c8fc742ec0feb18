#include "sim/scenes/routes.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr double kStepM = 2.5;
constexpr double kClosestM = 0.5;

void append_leg(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& to) {
  const Eigen::Vector3d from = points.back();
  const double length = (to - from).norm();
  if (length < kClosestM) return;
  const int steps = static_cast<int>(std::ceil(length / kStepM));
  for (int i = 1; i <= steps; ++i) points.push_back(from + (to - from) * i / steps);
}

// A quadratic Bezier from one leg to the other, which it leaves and meets along them.
void append_turn(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& before, const Eigen::Vector3d& corner,
                 const Eigen::Vector3d& after, double radius) {
  const Eigen::Vector3d in = (corner - before).normalized();
  const Eigen::Vector3d out = (after - corner).normalized();
  const double half_turn = std::acos(std::clamp(in.dot(out), -1.0, 1.0)) / 2.0;
  constexpr double kAlmostStraight = 0.02;
  constexpr double kAlmostBack = 1.4;  // turning on the spot
  const double room = 0.45 * std::min((corner - before).norm(), (after - corner).norm());
  if (half_turn < kAlmostStraight || half_turn > kAlmostBack) return append_leg(points, corner);
  const double cut = std::min(radius * std::tan(half_turn), room);
  const Eigen::Vector3d begin = corner - cut * in;
  const Eigen::Vector3d end = corner + cut * out;
  append_leg(points, begin);
  append_leg(points, 0.25 * begin + 0.5 * corner + 0.25 * end);
  append_leg(points, end);
}

}  // namespace

Route make_route(std::string name, const std::vector<Eigen::Vector3d>& corners, double turn_radius_m, bool closed) {
  Route route{.name = std::move(name), .points = {corners.front()}, .closed = closed};
  const std::size_t count = corners.size();
  for (std::size_t i = 1; i < (closed ? count : count - 1); ++i) {
    append_turn(route.points, corners[i - 1], corners[i], corners[(i + 1) % count], turn_radius_m);
  }
  append_leg(route.points, closed ? corners.front() : corners.back());
  const bool meets_itself = closed && (route.points.back() - route.points.front()).norm() < kClosestM;
  if (meets_itself && route.points.size() > 2) route.points.pop_back();
  return route;
}

Route rectangular_route(std::string name, const Eigen::Vector3d& centre, const Eigen::Vector2d& half_size,
                        double turn_radius_m) {
  const auto at = [&](double x, double y) { return Eigen::Vector3d(centre + Eigen::Vector3d(x, y, 0.0)); };
  const double x = half_size.x();
  const double y = half_size.y();
  return make_route(std::move(name), {at(0.0, -y), at(x, -y), at(x, y), at(-x, y), at(-x, -y)}, turn_radius_m, true);
}

Route flown(Route route) {
  route.flown = true;
  return route;
}

double length_of(const Route& route) {
  double length = 0.0;
  for (std::size_t i = 1; i < route.points.size(); ++i) length += (route.points[i] - route.points[i - 1]).norm();
  if (route.closed) length += (route.points.front() - route.points.back()).norm();
  return length;
}

}  // namespace plumbline
