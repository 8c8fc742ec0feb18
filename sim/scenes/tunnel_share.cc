#include "sim/scenes/tunnel_share.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace plumbline {
namespace {

constexpr double kLidarHeight_m = 1.5;
constexpr double kReach_m = 100.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

struct BoxHit {
  double distance_m = kNever;
  bool faces_axis = false;
};

/// A strip as the lidar has it before itself.
struct Face {
  explicit Face(const TunnelStrip& strip)
      : across(strip.across()),
        normal(strip.normal()),
        half_width(strip.width / 2.0 + strip.overlap),
        lidar_across((Eigen::Vector2d(0.0, kLidarHeight_m) - strip.middle).dot(across)),
        lidar_above((Eigen::Vector2d(0.0, kLidarHeight_m) - strip.middle).dot(normal)) {}

  Eigen::Vector2d across;
  Eigen::Vector2d normal;
  double half_width;
  double lidar_across;
  double lidar_above;
};

/// Distance from the lidar to a strip of unlimited length along a ray.
double distance_to(const Face& face, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d in_section = direction.tail<2>();
  const double approach = -in_section.dot(face.normal);
  if (approach <= 0.0) return kNever;
  const double distance = face.lidar_above / approach;
  const double across = face.lidar_across + distance * in_section.dot(face.across);
  return std::abs(across) <= face.half_width ? distance : kNever;
}

/// A ray from a place s against a box, by its slabs.
BoxHit hit_box(const StandOut& thing, const Face& face, double s, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d in_section = direction.tail<2>();
  const double origin[] = {s, face.lidar_across, face.lidar_above};
  const double along[] = {direction.x(), in_section.dot(face.across), in_section.dot(face.normal)};
  const double low[] = {thing.from, thing.low, 0.0};
  const double high[] = {thing.to, thing.high, thing.depth};
  BoxHit hit{0.0, false};
  double leave = kNever;
  for (int axis = 0; axis < 3; ++axis) {
    const double one = (low[axis] - origin[axis]) / along[axis];
    const double other = (high[axis] - origin[axis]) / along[axis];
    if (std::min(one, other) > hit.distance_m) hit = {std::min(one, other), axis == 0};
    leave = std::min(leave, std::max(one, other));
  }
  return hit.distance_m < leave ? hit : BoxHit{};
}

/// Things in the order of their begins, so that a ray looks only at those it passes.
class Row {
 public:
  Row(std::vector<StandOut> things, const std::vector<TunnelStrip>& lining)
      : things_(std::move(things)), faces_(lining.begin(), lining.end()) {
    std::stable_sort(things_.begin(), things_.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    for (const StandOut& thing : things_) longest_ = std::max(longest_, thing.to - thing.from);
  }

  /// The first hit within reach of a ray from s, in the order in which the ray passes.
  BoxHit first_hit(double s, const Eigen::Vector3d& direction, double reach_m) const {
    BoxHit nearest;
    const auto look_at = [&](const StandOut& thing) {
      const BoxHit hit = hit_box(thing, faces_[thing.strip], s, direction);
      if (hit.distance_m < std::min(nearest.distance_m, reach_m)) nearest = hit;
      return s + std::min(nearest.distance_m, reach_m) * direction.x();  // nothing beyond counts
    };
    double limit = s + reach_m * direction.x();
    if (direction.x() > 0.0) {
      for (auto it = first_from(s - longest_); it != things_.end() && it->from <= limit; ++it) limit = look_at(*it);
    } else {
      for (auto it = first_from(s); it != things_.begin() && std::prev(it)->from >= limit - longest_; --it) {
        limit = look_at(*std::prev(it));
      }
    }
    return nearest;
  }

 private:
  std::vector<StandOut>::const_iterator first_from(double s) const {
    return std::lower_bound(things_.begin(), things_.end(), s,
                            [](const StandOut& thing, double value) { return thing.from < value; });
  }

  std::vector<StandOut> things_;
  std::vector<Face> faces_;
  double longest_ = 0.0;
};

}  // namespace

AxisFacingShare::AxisFacingShare(const TunnelPlan& plan)
    : begin_(plan.line.begin()), end_(plan.line.end()), lining_(tunnel_lining(plan)) {
  constexpr int kPlaces = 32;
  const double straight = (plan.line.bends() ? plan.line.bend_begin() : end_) - begin_;
  for (int i = 0; i < kPlaces; ++i) places_.push_back(begin_ + straight * (0.2 + 0.6 * (i + 0.5) / kPlaces));
  std::vector<TunnelStrip> surfaces = tunnel_road(plan);
  surfaces.insert(surfaces.end(), lining_.begin(), lining_.end());
  const std::vector<Face> faces(surfaces.begin(), surfaces.end());
  constexpr int kAzimuths = kFans * 180;
  for (int i = 0; i < kAzimuths; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * (i + 0.37) / kAzimuths;  // never along an axis
    for (int line = 0; line < 16; ++line) {
      const double elevation = (-15.0 + 2.0 * line) * std::numbers::pi / 180.0;
      Ray ray{{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)},
              kNever};
      for (const Face& face : faces) ray.lining_m = std::min(ray.lining_m, distance_to(face, ray.direction));
      fans_[static_cast<std::size_t>(i % kFans)].push_back(ray);
    }
  }
}

double AxisFacingShare::of(const std::vector<StandOut>& stand_outs) const {
  const Row row(stand_outs, lining_);
  int returns = 0;
  int facing = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double place = places_[i];
    for (const Ray& ray : fans_[i % kFans]) {
      const double along = ray.direction.x();
      const double to_end = ((along > 0.0 ? end_ : begin_) - place) / along;  // beyond it there is nothing
      const double reach = std::min({ray.lining_m, kReach_m, to_end});
      const BoxHit nearest = row.first_hit(place, ray.direction, reach);
      const bool returns_something = nearest.distance_m < kNever || reach == ray.lining_m;
      returns += returns_something ? 1 : 0;
      facing += nearest.faces_axis ? 1 : 0;
    }
  }
  return static_cast<double>(facing) / std::max(1, returns);
}

std::vector<StandOut> things_for_share(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining,
                                       const std::vector<StandOut>& ribs) {
  if (plan.axis_facing <= 0.0) return {};
  const AxisFacingShare share(plan);
  const std::vector<StandOut> things = tunnel_things(plan, lining);
  const auto scaled = [&](double factor) { return with_depths_scaled(things, factor); };
  const auto share_at = [&](double factor) {
    std::vector<StandOut> all = scaled(factor);
    all.insert(all.end(), ribs.begin(), ribs.end());
    return share.of(all);
  };
  double low = 0.0;
  double high = 1.0;
  const double least = share_at(low);
  const double most = share_at(high);
  if (least > plan.axis_facing || most < plan.axis_facing) {
    throw std::invalid_argument("scene tunnel: axis_facing_percent is " + std::to_string(100.0 * plan.axis_facing) +
                                "; with these ribs and this section allowed is " + std::to_string(100.0 * least) +
                                " to " + std::to_string(100.0 * most));
  }
  constexpr int kHalvings = 9;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2.0;
    (share_at(middle) < plan.axis_facing ? low : high) = middle;
  }
  return scaled(high);
}

}  // namespace plumbline
