#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/scene_mesh.h"

namespace plumbline {

/// Collects scenery as triangles, a mesh for each material and each square tile of the ground. Each shape is given in a
/// local frame whose pose in the world is the last argument; corners run counter-clockwise seen from outside. Corners
/// are rounded to 2^-14 m in the world, so that shapes that share corners meet without a crack, across tiles, too.
class MeshBuilder {
 public:
  static constexpr double kTile_m = 64.0;

  void triangle(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c, const Pose& world_from_local = {});
  void quad(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
            const Eigen::Vector3d& d, const Pose& world_from_local = {});
  /// Convex and flat, three corners or more.
  void polygon(const std::string& material, const std::vector<Eigen::Vector3d>& corners,
               const Pose& world_from_local = {});
  void box(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
           const Pose& world_from_local = {});
  /// Upright walls over a footprint that is convex and counter-clockwise seen from above; with a top, without a floor.
  void prism(const std::string& walls, const std::string& top, const std::vector<Eigen::Vector2d>& footprint,
             double low_z, double high_z, const Pose& world_from_local = {});
  /// A round bar with `sides` flat sides and closed ends; a radius of 0 makes a cone's tip.
  void frustum(const std::string& material, const Eigen::Vector3d& from, double from_radius_m,
               const Eigen::Vector3d& to, double to_radius_m, int sides, const Pose& world_from_local = {});
  void cylinder(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                int sides, const Pose& world_from_local = {});
  /// Ground over a rectangle of the world's plan, facing up, in cells of at most step_m.
  /// @param height  z [m] at x, y of the world
  void terrain(const std::string& material, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double step_m,
               const std::function<double(double, double)>& height);

  std::size_t triangle_count() const { return triangle_count_; }

  /// Everything so far, sorted by material and tile; the builder is empty afterwards.
  std::vector<SceneMesh> take();

 private:
  void add_fan(const std::string& material, const std::vector<Eigen::Vector3d>& corners_in_world);

  std::map<std::tuple<std::string, int, int>, SceneMesh> meshes_;
  std::size_t triangle_count_ = 0;
};

}  // namespace plumbline
