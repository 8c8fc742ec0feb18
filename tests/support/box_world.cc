#include "tests/support/box_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumbline::testing {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

double cast_box(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse) {
  double enter = -kFar;
  double leave = kFar;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - origin[axis]) * inverse[axis];
    const double b = (box.high[axis] - origin[axis]) * inverse[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (leave < enter || leave <= 0.0) return kFar;
  if (box.hollow) return leave;
  return enter > 0.0 ? enter : kFar;
}

double cast_tube(double radius, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double a = direction.tail<2>().squaredNorm();
  const double b = origin.tail<2>().dot(direction.tail<2>());
  const double c = origin.tail<2>().squaredNorm() - radius * radius;
  return (-b + std::sqrt(b * b - a * c)) / a;
}

double cast_trunk(const Trunk& trunk, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d from = origin.head<2>() - trunk.axis;
  const double a = direction.head<2>().squaredNorm();
  const double b = from.dot(direction.head<2>());
  const double root = b * b - a * (from.squaredNorm() - trunk.radius_m * trunk.radius_m);
  return root >= 0.0 && b < 0.0 ? (-b - std::sqrt(root)) / a : kFar;
}

double distance_to_box(const Box& box, const Eigen::Vector3d& p) {
  const Eigen::Array3d outside = (box.low - p).array().max((p - box.high).array());
  const double inside_depth = outside.maxCoeff();
  return inside_depth <= 0.0 ? -inside_depth : outside.max(0.0).matrix().norm();
}

Box solid(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {{x0, y0, z0}, {x1, y1, z1}, false};
}

}  // namespace

double BoxWorld::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d inverse = direction.cwiseInverse();
  double nearest = tube_radius_m > 0.0 ? cast_tube(tube_radius_m, origin, direction) : kFar;
  for (const Box& box : boxes) nearest = std::min(nearest, cast_box(box, origin, inverse));
  for (const Trunk& trunk : trunks) nearest = std::min(nearest, cast_trunk(trunk, origin, direction));
  return nearest;
}

double BoxWorld::distance(const Eigen::Vector3d& point) const {
  double nearest = tube_radius_m > 0.0 ? std::abs(point.tail<2>().norm() - tube_radius_m) : kFar;
  for (const Box& box : boxes) nearest = std::min(nearest, distance_to_box(box, point));
  for (const Trunk& trunk : trunks) {
    nearest = std::min(nearest, std::abs((point.head<2>() - trunk.axis).norm() - trunk.radius_m));
  }
  return nearest;
}

BoxWorld smooth_tunnel() { return {{{{-500.0, -2.25, -1.2}, {500.0, 2.25, 1.8}, true}}, {}}; }

BoxWorld framed_corridor(double spacing_m) {
  BoxWorld world = smooth_tunnel();
  for (double x = -60.0; x <= 60.0; x += spacing_m) {
    for (const double jamb : {x, x + 1.0}) {
      world.boxes.push_back(solid(jamb, 2.13, -1.2, jamb + 0.15, 2.25, 0.9));
      world.boxes.push_back(solid(jamb, -2.25, -1.2, jamb + 0.15, -2.13, 0.9));
    }
  }
  return world;
}

BoxWorld furnished_room() {
  BoxWorld world;
  world.boxes = {{{-6.0, -4.5, -1.0}, {6.0, 4.5, 2.2}, true}, solid(-5.9, -4.4, -1.0, -4.8, -1.5, 1.0),
                 solid(3.0, 2.0, -1.0, 3.4, 2.4, 2.2),        solid(-2.2, -3.1, -1.0, -1.8, -2.7, 2.2),
                 solid(1.0, -4.4, -1.0, 3.2, -3.7, 0.0),      solid(4.0, -1.0, -1.0, 5.2, 1.2, -0.25),
                 solid(-3.0, 3.2, -1.0, -1.0, 4.4, 0.8),      solid(0.5, 2.8, -1.0, 1.1, 3.4, -0.5)};
  return world;
}

BoxWorld pillared_hall(double length_m) {
  BoxWorld world;
  world.boxes.push_back({{-15.0, -7.0, -1.0}, {length_m + 15.0, 7.0, 4.0}, true});
  RandomStream place(7, "pillared_hall");
  for (double x = -12.0; x < length_m + 12.0; x += place.uniform(3.0, 6.0)) {
    const double side = place.uniform() < 0.5 ? -1.0 : 1.0;
    const double y = side * place.uniform(3.0, 5.5);
    const double half = place.uniform(0.2, 0.5);
    const double height = place.uniform() < 0.5 ? 4.0 : place.uniform(-0.2, 1.5);
    world.boxes.push_back(solid(x - half, y - half, -1.0, x + half, y + half, height));
  }
  return world;
}

BoxWorld avenue(double length_m) {
  BoxWorld world;
  world.boxes.push_back({{-200.0, -200.0, -1.2}, {length_m + 200.0, 200.0, 60.0}, true});
  RandomStream place(9, "avenue");
  for (const double side : {-1.0, 1.0}) {
    for (double x = -20.0; x < length_m + 20.0; x += place.uniform(2.5, 5.0)) {
      world.trunks.push_back({{x, side * place.uniform(3.0, 6.0)}, place.uniform(0.1, 0.2)});
    }
  }
  return world;
}

BoxWorld thicket(double length_m) {
  BoxWorld world;
  world.boxes.push_back({{-200.0, -200.0, -1.2}, {length_m + 200.0, 200.0, 60.0}, true});
  RandomStream place(10, "thicket");
  for (const double side : {-1.0, 1.0}) {
    for (double x = -8.0; x < length_m + 8.0; x += place.uniform(1.0, 2.5)) {
      const Eigen::Vector3d middle(x, side * place.uniform(2.5, 6.0), place.uniform(-0.2, 1.2));
      for (int leaf = 0; leaf < 120; ++leaf) {
        const Eigen::Vector3d at = middle + Eigen::Vector3d(place.gaussian(), place.gaussian(), place.gaussian()) * 0.5;
        const Eigen::Vector3d half(place.uniform(0.01, 0.15), place.uniform(0.01, 0.15), place.uniform(0.01, 0.15));
        world.boxes.push_back({at - half, at + half, false});
      }
    }
  }
  return world;
}

LidarScan vlp16_scan(const BoxWorld& world, const Motion& motion, std::int64_t stamp_ns, const Pose& body_from_lidar,
                     double range_sigma_m, RandomStream& noise) {
  constexpr int kFirings = 1808;
  constexpr int kRings = 16;
  constexpr double kRadians = std::numbers::pi / 180.0;
  LidarScan scan;
  scan.stamp_ns = stamp_ns;
  scan.end_ns = stamp_ns + 100'000'000;
  for (int firing = 0; firing < kFirings; ++firing) {
    const std::int64_t offset_ns = 100'000'000LL * firing / kFirings;
    const Pose world_from_lidar = motion(1e-9 * static_cast<double>(stamp_ns + offset_ns)) * body_from_lidar;
    const double azimuth = -2.0 * std::numbers::pi * firing / kFirings;
    for (int ring = 0; ring < kRings; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * kRadians;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                 std::sin(elevation));
      const double range = world.cast(world_from_lidar.translation, world_from_lidar.rotation * beam);
      if (!(range < 100.0)) continue;
      LidarPoint point;
      point.position = ((range + range_sigma_m * noise.gaussian()) * beam).cast<float>();
      point.offset_ns = static_cast<std::int32_t>(offset_ns);
      point.ring = static_cast<std::uint16_t>(ring);
      scan.points.push_back(point);
    }
  }
  return scan;
}

std::vector<LidarScan> turned_scanner_sweep(const BoxWorld& world, const Motion& motion, std::int64_t sweep,
                                            double range_sigma_m, RandomStream& noise) {
  constexpr int kParts = 10;
  constexpr int kLines = 4;  // a part
  constexpr int kSteps = 361;
  constexpr std::int64_t kLine_ns = 25'000'000;
  std::vector<LidarScan> parts(kParts);
  for (int line = 0; line < kParts * kLines; ++line) {
    LidarScan& part = parts[static_cast<std::size_t>(line / kLines)];
    part.stamp_ns = 1'000'000'000 * sweep + line / kLines * kLines * kLine_ns;
    part.end_ns = part.stamp_ns + kLines * kLine_ns;
    part.sweep = sweep;
    part.ends_sweep = line / kLines == kParts - 1;
    for (int step = 0; step < kSteps; ++step) {
      const std::int64_t offset_ns = line % kLines * kLine_ns + kLine_ns / 2 * step / kSteps;
      const double time_s = 1e-9 * static_cast<double>(part.stamp_ns + offset_ns);
      const double turned = time_s - static_cast<double>(sweep) - 0.5;
      const double joint = std::numbers::pi * (sweep % 2 == 0 ? turned : -turned);
      const double angle = std::numbers::pi * (static_cast<double>(step) / (kSteps - 1) - 0.5);
      const Eigen::Vector3d beam(std::cos(angle), std::sin(angle) * std::cos(joint), std::sin(angle) * std::sin(joint));
      const Pose world_from_lidar = motion(time_s);
      const double range = world.cast(world_from_lidar.translation, world_from_lidar.rotation * beam);
      if (!(range < 30.0)) continue;
      LidarPoint point;
      point.position = ((range + range_sigma_m * noise.gaussian()) * beam).cast<float>();
      point.offset_ns = static_cast<std::int32_t>(offset_ns);
      point.ring = static_cast<std::uint16_t>(line);
      part.points.push_back(point);
    }
  }
  return parts;
}

}  // namespace plumbline::testing
