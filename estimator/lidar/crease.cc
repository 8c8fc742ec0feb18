#include "estimator/lidar/crease.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace plumbline {
namespace {

constexpr int kLargestWindow = 81;
constexpr int kLeastPerSide = 4;
constexpr float kLeastTurnSine = 0.5F;    // 30 degrees
constexpr float kLargestMisfit = 1.5F;    // root mean square distance to the lines over range noise
constexpr double kLargestRadius_m = 0.6;  // of a trunk or a column
// By so many variances of a return must a circle explain the returns better than a straight line does: with a parameter
// more it always gains one.
constexpr double kLeastGain = 10.0;

/// Sums from which a line through a window's points follows.
struct Moments {
  float n = 0.0F;
  float x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F;

  Moments operator-(const Moments& o) const { return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy}; }
};

struct Line {
  Eigen::Vector2f point = Eigen::Vector2f::Zero();
  Eigen::Vector2f direction = Eigen::Vector2f::UnitX();
  float misfit = 0.0F;  // sum of squared distances
};

/// Total least squares: the noise lies along the beam, which may be along either axis.
Line fit(const Moments& m) {
  const float mean_x = m.x / m.n;
  const float mean_y = m.y / m.n;
  const float a = m.xx - m.x * mean_x;
  const float b = m.xy - m.x * mean_y;
  const float c = m.yy - m.y * mean_y;
  const float half_gap = std::hypot(0.5F * (a - c), b);
  const float angle = 0.5F * std::atan2(2.0F * b, a - c);
  return {{mean_x, mean_y}, {std::cos(angle), std::sin(angle)}, std::max(0.0F, 0.5F * (a + c) - half_gap)};
}

/// A window's points in the plane of its chord and its bend, with running sums.
struct Profile {
  Eigen::Vector3f origin;
  Eigen::Vector3f along;
  Eigen::Vector3f bend;
  int count = 0;
  std::array<Moments, kLargestWindow + 1> sums;
  std::array<Eigen::Vector2f, kLargestWindow> points;

  std::span<const Eigen::Vector2f> used() const { return {points.data(), static_cast<std::size_t>(count)}; }
  Eigen::Vector3f in_body(const Eigen::Vector2f& p) const { return origin + p.x() * along + p.y() * bend; }
};

Profile profile_of(const RingTable& table, int i, int half_window) {
  Profile p;
  const int first = i - half_window;
  p.count = 2 * half_window + 1;
  p.origin = table.mean(first, i + half_window);
  p.along = (table.mean(i + 1, i + half_window) - table.mean(first, i - 1)).normalized();
  const int third = std::max(1, half_window / 3);
  const Eigen::Vector3f offset = table.mean(i - third, i + third) - p.origin;
  p.bend = (offset - offset.dot(p.along) * p.along).normalized();
  for (int k = 0; k < p.count; ++k) {
    const Eigen::Vector3f d = table.position(first + k) - p.origin;
    const float x = d.dot(p.along);
    const float y = d.dot(p.bend);
    p.points[static_cast<std::size_t>(k)] = {x, y};
    const Moments& s = p.sums[static_cast<std::size_t>(k)];
    p.sums[static_cast<std::size_t>(k) + 1] = {s.n + 1.0F, s.x + x, s.y + y, s.xx + x * x, s.xy + x * y, s.yy + y * y};
  }
  return p;
}

/// Those to either side of the break that explains the returns best.
std::pair<Line, Line> fit_two_lines(const Profile& p, int half_window) {
  const Moments& all = p.sums[static_cast<std::size_t>(p.count)];
  std::pair<Line, Line> best;
  float least = std::numeric_limits<float>::infinity();
  const int sway = std::min(half_window / 2, half_window - kLeastPerSide + 1);
  for (int k = half_window - sway; k <= half_window + 1 + sway; ++k) {
    const Moments& head = p.sums[static_cast<std::size_t>(k)];
    const Line left = fit(head);
    const Line right = fit(all - head);
    if (left.misfit + right.misfit >= least) continue;
    least = left.misfit + right.misfit;
    best = {left, right};
  }
  return best;
}

struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;
  double misfit = 0.0;  // sum of squared distances
};

/// Least squares of |p|^2 = 2 centre . p + constant (Kasa, IEEE Trans. Instrum. Meas. 25(1), 1976), a first guess:
/// noise makes its circles too small.
Circle guess_circle(std::span<const Eigen::Vector2f> points) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2f& point : points) {
    const Eigen::Vector2d p = point.cast<double>();
    const Eigen::Vector3d row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    normal += row * row.transpose();
    right += p.squaredNorm() * row;
  }
  const Eigen::Vector3d solved = normal.ldlt().solve(right);
  return {solved.head<2>(), std::sqrt(std::max(0.0, solved.z() + solved.head<2>().squaredNorm())), 0.0};
}

/// Least squares of the distances, by Gauss and Newton.
Circle fit_circle(std::span<const Eigen::Vector2f> points) {
  constexpr int kIterations = 4;
  Circle circle = guess_circle(points);
  for (int iteration = 0;; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    circle.misfit = 0.0;
    for (const Eigen::Vector2f& p : points) {
      const Eigen::Vector2d from_centre = p.cast<double>() - circle.centre;
      const double distance = from_centre.norm();
      const double residual = distance - circle.radius;
      const Eigen::Vector3d row(from_centre.x() / distance, from_centre.y() / distance, 1.0);
      circle.misfit += residual * residual;
      normal += row * row.transpose();
      right += residual * row;
    }
    if (iteration == kIterations) return circle;
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    circle.centre += step.head<2>();
    circle.radius += step.z();
  }
}

/// Whether a circle no larger than a column explains the returns better than two lines with such a misfit do, though
/// these have two parameters more.
bool is_round(const Circle& circle, double misfit_of_lines) {
  return circle.radius < kLargestRadius_m && circle.misfit < misfit_of_lines;
}

}  // namespace

std::optional<Eigen::Vector3f> fit_crease(const RingTable& table, int i, int half_window, float range_sigma) {
  if (2 * half_window + 1 > kLargestWindow) return std::nullopt;
  const Profile p = profile_of(table, i, half_window);
  const auto [left, right] = fit_two_lines(p, half_window);
  const double misfit_of_lines = double{left.misfit + right.misfit};
  const float turn = left.direction.x() * right.direction.y() - left.direction.y() * right.direction.x();
  if (std::abs(turn) < kLeastTurnSine) return std::nullopt;
  const double largest_misfit = std::pow(double{kLargestMisfit} * double{range_sigma}, 2.0);
  const bool bulges = p.bend.dot(table.beam(i)) < 0.0F;
  if (bulges) {
    const Circle circle = fit_circle(p.used());
    const bool fits = circle.misfit / (p.count - 3) < largest_misfit;
    if (fits && is_round(circle, misfit_of_lines)) return p.in_body(circle.centre.cast<float>());
  }
  if (misfit_of_lines / std::max(1, p.count - 5) > largest_misfit) return std::nullopt;
  const Eigen::Vector2f gap = right.point - left.point;
  const float reach = (gap.x() * right.direction.y() - gap.y() * right.direction.x()) / turn;
  const Eigen::Vector2f crossing = left.point + reach * left.direction;
  const Eigen::Vector3f position = p.in_body(crossing);
  // Lines that cross far from the returns between them are not those of an edge here.
  const float extent = (table.position(i + half_window) - table.position(i - half_window)).norm();
  if ((position - table.position(i)).norm() > 0.5F * extent) return std::nullopt;
  return position;
}

bool is_round(const RingTable& table, int i, int half_window) {
  if (half_window < kLeastPerSide || 2 * half_window + 1 > kLargestWindow) return false;
  const Profile p = profile_of(table, i, half_window);
  const auto [left, right] = fit_two_lines(p, half_window);
  const Circle circle = fit_circle(p.used());
  const double misfit_of_line = double{fit(p.sums[static_cast<std::size_t>(p.count)]).misfit};
  return is_round(circle, double{left.misfit + right.misfit}) &&
         misfit_of_line - circle.misfit > kLeastGain * circle.misfit / (p.count - 3);
}

}  // namespace plumbline
