#include "estimator/lidar/crease.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumbline {
namespace {

constexpr int kLargestWindow = 81;
constexpr int kLeastPerSide = 4;
constexpr float kLeastTurnSine = 0.5F;  // 30 degrees
constexpr float kLargestMisfit = 1.5F;  // root mean square distance to the lines over range noise

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
    const Moments& s = p.sums[static_cast<std::size_t>(k)];
    p.sums[static_cast<std::size_t>(k) + 1] = {s.n + 1.0F, s.x + x, s.y + y, s.xx + x * x, s.xy + x * y, s.yy + y * y};
  }
  return p;
}

}  // namespace

std::optional<Eigen::Vector3f> fit_crease(const RingTable& table, int i, int half_window, float range_sigma) {
  if (2 * half_window + 1 > kLargestWindow) return std::nullopt;
  const Profile p = profile_of(table, i, half_window);
  const Moments& all = p.sums[static_cast<std::size_t>(p.count)];
  Line left;
  Line right;
  float least = std::numeric_limits<float>::infinity();
  const int sway = std::min(half_window / 2, half_window - kLeastPerSide + 1);
  for (int k = half_window - sway; k <= half_window + 1 + sway; ++k) {
    const Moments& head = p.sums[static_cast<std::size_t>(k)];
    const Line l = fit(head);
    const Line r = fit(all - head);
    if (l.misfit + r.misfit >= least) continue;
    least = l.misfit + r.misfit;
    left = l;
    right = r;
  }
  const float turn = left.direction.x() * right.direction.y() - left.direction.y() * right.direction.x();
  if (std::abs(turn) < kLeastTurnSine) return std::nullopt;
  const float freedom = static_cast<float>(std::max(1, p.count - 5));
  if (least / freedom > std::pow(kLargestMisfit * range_sigma, 2.0F)) return std::nullopt;
  const Eigen::Vector2f gap = right.point - left.point;
  const float reach = (gap.x() * right.direction.y() - gap.y() * right.direction.x()) / turn;
  const Eigen::Vector2f crossing = left.point + reach * left.direction;
  const Eigen::Vector3f position = p.origin + crossing.x() * p.along + crossing.y() * p.bend;
  // Lines that cross far from the returns between them are not those of an edge here.
  const float extent = (table.position(i + half_window) - table.position(i - half_window)).norm();
  if ((position - table.position(i)).norm() > 0.5F * extent) return std::nullopt;
  return position;
}

}  // namespace plumbline
