#include "tools/verify/lidar_spread_check.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "estimator/geometry/symmetric_eigen.h"
#include "scenarios/catalogue.h"
#include "sensors/lidar.h"

namespace plumbline {
namespace {

constexpr int kPatchPoints = 24;  // on each of two neighbouring rings

struct Patch {
  double range_m = 0.0;
  double sigma_m = 0.0;  ///< of the ranges about the plane that fits the points best
};

/// Two neighbouring rings of one scan: the plane's three parameters take up what is constant of either ring.
Patch patch_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  const SymmetricEigen<Eigen::Matrix3d> eigen(scatter);
  const Eigen::Vector3d normal = eigen.vectors.col(0);
  Patch patch;
  for (const Eigen::Vector3d& point : points) {
    const double along_beam_m = normal.dot(point - mean) / normal.dot(point.normalized());
    patch.sigma_m += along_beam_m * along_beam_m;
    patch.range_m += point.norm() / static_cast<double>(points.size());
  }
  patch.sigma_m = std::sqrt(patch.sigma_m / static_cast<double>(points.size() - 3));
  return patch;
}

/// A room with the lidar at its origin.
struct Room {
  Eigen::Vector3d half_size;

  std::string geom() const {
    return "<geom type=\"box\" material=\"wall\" size=\"" + std::to_string(half_size.x()) + " " +
           std::to_string(half_size.y()) + " " + std::to_string(half_size.z()) + "\"/>";
  }
  /// The wall that all points are on, away from corners and seen at less than 60 degrees.
  bool is_patch(const std::vector<Eigen::Vector3d>& points) const {
    Eigen::Index wall = 0;
    (half_size - points.front().cwiseAbs()).minCoeff(&wall);
    return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d slack = half_size - point.cwiseAbs();
      return std::abs(slack[wall]) < 0.2 && (slack.array() < 0.3).count() == 1 &&
             std::abs(point[wall]) > 0.5 * point.norm();
    });
  }
};

/// Patches of a room with walls of half the light's reflectance.
std::vector<Patch> patches_of(const Lidar& lidar, const Room& room) {
  SceneDescription scene;
  scene.mjcf = "<mujoco><asset><material name=\"wall\"/></asset><worldbody>" + room.geom() + "</worldbody></mujoco>";
  Material wall;
  wall.name = "wall";
  wall.lidar_reflectivity = 0.5F;
  scene.materials = {wall};
  const World world = World::from_scene(scene, 1);
  const RayScene rays(world);
  PoseTrack at_rest;
  at_rest.push(0, Pose{});
  at_rest.push(10'000'000'000, Pose{});

  std::vector<Patch> patches;
  std::vector<std::vector<Eigen::Vector3d>> rings(static_cast<std::size_t>(ring_count(lidar.model())));
  for (int message = 0; message < messages_per_sweep(lidar.model()); ++message) {
    const LidarScan scan = lidar.scan({world, rays}, at_rest, message * lidar.period_ns(), message);
    for (const LidarPoint& point : scan.points) rings[point.ring].push_back(point.position.cast<double>());
  }
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (std::size_t i = 0; i + kPatchPoints <= std::min(rings[ring].size(), rings[ring + 1].size());
         i += kPatchPoints) {
      std::vector<Eigen::Vector3d> points;
      for (const auto& of : {rings[ring], rings[ring + 1]})
        points.insert(points.end(), of.begin() + static_cast<std::ptrdiff_t>(i),
                      of.begin() + static_cast<std::ptrdiff_t>(i + kPatchPoints));
      if (room.is_patch(points)) patches.push_back(patch_of(points));
    }
  }
  return patches;
}

std::vector<SpreadCheck> real_devices() {
  return {{"vlp16", 1.0, 5.0, 6.5e-3},
          {"vlp16", 10.0, 20.0, 14e-3},
          {"hdl32e", 3.0, 20.0, 6.25e-3},
          {"hdl32e", 20.0, 30.0, 10e-3},
          {"hdl64e", 3.0, 5.0, 8e-3},
          {"hdl64e", 5.0, 10.0, 10e-3},
          {"hdl64e", 10.0, 20.0, 22e-3},
          {"utm30lx_sweeping", 0.1, 10.0, 10e-3},
          {"utm30lx_sweeping", 10.0, 30.0, 30e-3}};
}

std::vector<Patch> patches_of(const std::string& device) {
  const Lidar lidar(catalogue_lidar(device), Pose{}, 1);
  std::vector<Patch> patches;
  for (const Eigen::Vector3d& half_size :
       {Eigen::Vector3d(4, 3, 2), Eigen::Vector3d(9, 6, 3), Eigen::Vector3d(18, 12, 5), Eigen::Vector3d(28, 23, 8)}) {
    const std::vector<Patch> found = patches_of(lidar, {half_size});
    patches.insert(patches.end(), found.begin(), found.end());
  }
  return patches;
}

}  // namespace

std::vector<SpreadCheck> check_lidar_spread() {
  std::vector<SpreadCheck> checks = real_devices();
  std::map<std::string, std::vector<Patch>> patches;
  for (SpreadCheck& check : checks) {
    if (!patches.contains(check.device)) patches[check.device] = patches_of(check.device);
    std::vector<double> sigmas;
    for (const Patch& patch : patches[check.device])
      if (patch.range_m >= check.least_range_m && patch.range_m < check.greatest_range_m)
        sigmas.push_back(patch.sigma_m);
    check.patches = sigmas.size();
    if (sigmas.empty()) continue;
    const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
    std::nth_element(sigmas.begin(), middle, sigmas.end());
    check.sigma_m = *middle;
  }
  return checks;
}

}  // namespace plumbline
