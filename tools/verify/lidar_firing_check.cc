#include "tools/verify/lidar_firing_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "scenarios/catalogue.h"
#include "sensors/lidar.h"
#include "sim/constants.h"
#include "tools/verify/lidar_stand.h"

namespace plumbline {
namespace {

Lidar ideal(const std::string& name, double rate_hz = 0.0) {
  LidarModel model = catalogue_lidar(name);
  if (rate_hz > 0.0) model.rate_hz = rate_hz;
  return Lidar(model, Pose{}, 1, LidarEffects::none());
}

double wrapped_deg(double degrees) { return std::remainder(degrees, 360.0); }

struct SheetBeam {
  double elevation_deg = 0.0;
  double origin_z_m = 0.0;
  double firing_us = 0.0;
};

using Sheet = std::function<SheetBeam(int ring)>;

SheetBeam vlp16_sheet(int ring) {
  // Rings alternate between the first and the second eight lasers of the table; offsets by laser.
  constexpr std::array<double, 16> kOffset_mm = {11.2, 9.7,  8.1,  6.6,  5.1,  3.7,  2.2,  0.7,
                                                 -0.7, -2.2, -3.7, -5.1, -6.6, -8.1, -9.7, -11.2};
  const int laser = ring < 8 ? 2 * ring : 2 * ring - 15;
  return {2.0 * ring - 15.0, 1e-3 * kOffset_mm[static_cast<std::size_t>(ring)], 2.304 * laser};
}

SheetBeam hdl32e_sheet(int ring) {
  constexpr std::array<double, 32> kInFiringOrder = {-30.67, -9.33, -29.33, -8.00, -28.00, -6.66, -26.66, -5.33,
                                                     -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0,
                                                     -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                                     -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67};
  std::array<double, 32> ascending = kInFiringOrder;
  std::sort(ascending.begin(), ascending.end());
  const double elevation_deg = ascending[static_cast<std::size_t>(ring)];
  const auto laser = std::find(kInFiringOrder.begin(), kInFiringOrder.end(), elevation_deg) - kInFiringOrder.begin();
  return {elevation_deg, 0.0, 1.152 * static_cast<double>(laser)};
}

SheetBeam hdl64e_sheet(int ring, double group_us, const std::array<double, 4>& within_group_us) {
  // Lasers of either block from the lowest to the highest.
  constexpr std::array<int, 32> kLaser = {6,  7,  10, 11, 0,  1,  4,  5,  8,  9,  14, 15, 18, 19, 22, 23,
                                          12, 13, 16, 17, 20, 21, 26, 27, 30, 31, 2,  3,  24, 25, 28, 29};
  const bool upper = ring >= 32;
  const int from_top = (upper ? 63 : 31) - ring;
  const double elevation_deg = upper ? 2.0 - from_top / 3.0 : -8.83 - 0.5 * from_top;
  const double origin_mm = upper ? 206.5 + 1.263 * elevation_deg : 135.6 + 1.208 * elevation_deg;
  const auto laser = static_cast<std::size_t>(kLaser[static_cast<std::size_t>(31 - from_top)]);
  return {elevation_deg, 1e-3 * std::round(10.0 * origin_mm) / 10.0,
          group_us * static_cast<double>(laser / 4) + within_group_us[laser % 4]};
}

struct SpinningCase {
  std::string name;
  double cycle_us;
  int lasers;
  std::vector<double> rates_hz;
  Sheet sheet;
};

std::vector<SpinningCase> spinning_cases() {
  return {{"vlp16", 55.296, 16, {5, 10, 20}, vlp16_sheet},
          {"hdl32e", 46.08, 32, {5, 10, 20}, hdl32e_sheet},
          {"hdl64e",
           48.0,
           64,
           {5, 10, 15},
           [](int ring) {
             return hdl64e_sheet(ring, 6.0, {0, 1.26, 2.46, 3.66});
           }},
          {"hdl64e_s3", 57.6, 64, {5, 10, 20}, [](int ring) {
             return hdl64e_sheet(ring, 7.2, {0, 1.3, 2.5, 3.7});
           }}};
}

void see(double error, double& worst) { worst = std::max(worst, std::abs(error)); }

double elevation_deg(const Eigen::Vector3d& ray) { return std::atan2(ray.z(), std::hypot(ray.x(), ray.y())) / kDegree; }
double azimuth_deg(const Eigen::Vector3d& ray) { return std::atan2(ray.y(), ray.x()) / kDegree; }

FiringCheck check_velodyne(const LidarStand& sphere, const SpinningCase& device, double rate_hz) {
  const Lidar lidar = ideal(device.name, rate_hz);
  FiringCheck check{.device = device.name, .rate_hz = rate_hz};
  const auto period_ns = static_cast<double>(lidar.period_ns());
  const auto messages = static_cast<std::int64_t>(rate_hz);
  for (std::int64_t message = 0; message < messages; ++message) {
    const LidarScan scan = sphere.scan(lidar, message);
    check.points += static_cast<std::int64_t>(scan.points.size());
    if (message != 0 && message != messages - 1) continue;
    for (const LidarPoint& point : scan.points) {
      const SheetBeam beam = device.sheet(point.ring);
      // The firing clock runs on over the revolutions, from message 0.
      const double since_start_ns = static_cast<double>(message) * period_ns + point.offset_ns;
      see(std::remainder(since_start_ns - 1e3 * beam.firing_us, 1e3 * device.cycle_us), check.worst_time_ns);
      const Eigen::Vector3d ray = point.position.cast<double>() - Eigen::Vector3d(0, 0, beam.origin_z_m);
      see(elevation_deg(ray) - beam.elevation_deg, check.worst_angle_deg);
      see(wrapped_deg(azimuth_deg(ray) - 180.0 + 360.0 * point.offset_ns / period_ns), check.worst_angle_deg);
    }
  }
  // No firing is lost between revolutions, whose lengths are no multiples of the cycle's.
  const double second_us = 1e-3 * period_ns * static_cast<double>(messages);
  for (int ring = 0; ring < device.lasers; ++ring) {
    check.expected_points +=
        static_cast<std::int64_t>(std::ceil((second_us - device.sheet(ring).firing_us) / device.cycle_us - 1e-9));
  }
  return check;
}

FiringCheck check_ouster(const LidarStand& sphere, int columns) {
  const Lidar lidar = ideal("os1_64_" + std::to_string(columns));
  FiringCheck check{.device = lidar.model().name, .rate_hz = lidar.model().rate_hz};
  check.expected_points = 64LL * columns * 10;
  for (std::int64_t message = 0; message < 10; ++message) {
    const LidarScan scan = sphere.scan(lidar, message);
    check.points += static_cast<std::int64_t>(scan.points.size());
    if (message != 3) continue;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& point = scan.points[i];
      const auto column = static_cast<int>(i / 64);
      const auto row = static_cast<int>(i % 64);
      see(point.offset_ns - 1e8 * column / columns, check.worst_time_ns);
      if (point.ring != 63 - row) ++check.misplaced;
      const double encoder_deg = 180.0 - 360.0 * column / columns;
      const Eigen::Vector3d origin(0.012163 * std::cos(encoder_deg * kDegree),
                                   0.012163 * std::sin(encoder_deg * kDegree), 0.0);
      const Eigen::Vector3d ray = point.position.cast<double>() - origin;
      constexpr std::array<double, 4> kStagger_deg = {3.164, 1.055, -1.055, -3.164};
      see(elevation_deg(ray) - 16.611 + 0.5273 * row, check.worst_angle_deg);
      see(wrapped_deg(azimuth_deg(ray) - encoder_deg - kStagger_deg[static_cast<std::size_t>(row % 4)]),
          check.worst_angle_deg);
    }
  }
  return check;
}

/// Steps of 0.25 degrees every 25 ms / 1440, the joint turned about x at 180 degrees per second.
FiringCheck check_utm30lx(const LidarStand& sphere, const std::string& name, int first_step, int last_step,
                          const std::function<double(double)>& joint_deg_at) {
  const Lidar lidar = ideal(name);
  FiringCheck check{.device = name, .rate_hz = lidar.model().rate_hz};
  const auto steps = static_cast<std::size_t>(last_step - first_step + 1);
  check.expected_points = 40 * static_cast<std::int64_t>(steps);
  for (std::int64_t message = 0; message < 25; ++message) {
    const LidarScan scan = sphere.scan(lidar, message);
    if (scan.sweep != message / 10 || scan.ends_sweep != (message % 10 == 9)) ++check.misplaced;
    if (message < 10) check.points += static_cast<std::int64_t>(scan.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& point = scan.points[i];
      const auto line = static_cast<int>(i / steps);
      const int step = first_step + static_cast<int>(i % steps);
      see(point.offset_ns - (25e6 * line + 25e6 / 1440.0 * step), check.worst_time_ns);
      if (point.ring != 4 * (message % 10) + line) ++check.misplaced;
      const double joint = joint_deg_at(1e-9 * (1e8 * static_cast<double>(message) + point.offset_ns)) * kDegree;
      const double in_plane = 0.25 * (step - 540) * kDegree;
      const Eigen::Vector3d expected(std::cos(in_plane), std::sin(in_plane) * std::cos(joint),
                                     std::sin(in_plane) * std::sin(joint));
      const Eigen::Vector3d ray = point.position.cast<double>().normalized();
      see(std::atan2(ray.cross(expected).norm(), ray.dot(expected)) / kDegree, check.worst_angle_deg);
    }
  }
  return check;
}

double back_and_forth_deg(double time_s) {
  const double into_round_s = std::fmod(time_s, 2.0);
  return into_round_s < 1.0 ? -90.0 + 180.0 * into_round_s : 270.0 - 180.0 * into_round_s;
}

double onwards_deg(double time_s) { return -90.0 + 180.0 * time_s; }

}  // namespace

std::vector<FiringCheck> check_lidar_firing() {
  const LidarStand sphere(kSphere);
  std::vector<FiringCheck> checks;
  for (const SpinningCase& device : spinning_cases()) {
    for (const double rate_hz : device.rates_hz) checks.push_back(check_velodyne(sphere, device, rate_hz));
  }
  for (const int columns : {1024, 2048}) checks.push_back(check_ouster(sphere, columns));
  checks.push_back(check_utm30lx(sphere, "utm30lx_sweeping", 180, 900, back_and_forth_deg));
  checks.push_back(check_utm30lx(sphere, "utm30lx_spinning", 0, 1080, onwards_deg));
  return checks;
}

}  // namespace plumbline
