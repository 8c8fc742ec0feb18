#include "tools/verify/lidar_stand.h"

#include <cmath>
#include <numbers>

namespace plumbline {

SceneDescription lidar_targets(const std::string& geoms, float reflectivity) {
  SceneDescription scene;
  scene.mjcf =
      "<mujoco><asset><material name=\"wall\"/></asset><default><geom material=\"wall\"/></default><worldbody>" +
      geoms + "</worldbody></mujoco>";
  Material wall;
  wall.name = "wall";
  wall.lidar_reflectivity = reflectivity;
  scene.materials = {wall};
  return scene;
}

LidarStand::LidarStand(const std::string& geoms, float reflectivity)
    : world(World::from_scene(lidar_targets(geoms, reflectivity), 1)), rays(world) {
  at_rest_.push(0, Pose{});
  at_rest_.push(100'000'000'000, Pose{});
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace plumbline
