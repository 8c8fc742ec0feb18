#include "tools/verify/deskew_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "estimator/geometry/so3.h"
#include "sensors/lidar.h"

namespace plumbline {

DeskewCheck check_deskew(const LidarModel& device) {
  const Eigen::Vector3d half_size(18.0, 14.0, 4.0);
  SceneDescription hall;
  hall.mjcf = R"(<mujoco><worldbody><geom type="box" size="18 14 4"/></worldbody></mujoco>)";
  const World world = World::from_scene(hall, 1);
  const auto distance = [&](const Eigen::Vector3d& point) {
    return (half_size - point.cwiseAbs()).cwiseAbs().minCoeff();
  };
  constexpr double kRate = 370.0 * std::numbers::pi / 180.0;
  PoseTrack track;
  Pose world_from_body{Eigen::Quaterniond::Identity(), {1.0, -2.0, 0.3}};
  for (std::int64_t stamp_ns = 0; stamp_ns <= 400'000'000; stamp_ns += 2'000'000) {
    track.push(stamp_ns, world_from_body);
    const double time_s = 1e-9 * static_cast<double>(stamp_ns);
    const Eigen::Vector3d axis = Eigen::Vector3d(0.4 * std::sin(9.0 * time_s), 0.3 * std::cos(7.0 * time_s), 1.0);
    world_from_body.rotation = world_from_body.rotation * exp_so3(kRate * 2e-3 * axis.normalized());
    world_from_body.translation += 2e-3 * Eigen::Vector3d(1.0, -0.5, 0.2);
  }
  const RayScene rays(world);
  const Pose body_from_lidar{exp_so3({0.1, -0.2, 0.3}), {0.2, 0.1, -0.1}};
  const Lidar lidar(device, body_from_lidar, 1, LidarEffects::none());
  DeskewCheck check;
  std::vector<double> rigid;
  for (std::int64_t index = 0; index < 4; ++index) {
    const LidarScan scan = lidar.scan({world, rays}, track, index * lidar.period_ns(), index);
    for (const LidarPoint& point : scan.points) {
      const Eigen::Vector3d in_body = body_from_lidar * point.position.cast<double>();
      check.worst_m = std::max(check.worst_m, distance(track.at(scan.stamp_ns + point.offset_ns) * in_body));
      rigid.push_back(distance(track.at(scan.stamp_ns) * in_body));
    }
  }
  check.points = rigid.size();
  const auto percentile_95 = rigid.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(rigid.size()));
  std::nth_element(rigid.begin(), percentile_95, rigid.end());
  check.raw_percentile_m = *percentile_95;
  return check;
}

}  // namespace plumbline
