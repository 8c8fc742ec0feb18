#pragma once

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/world.h"

namespace plumbline {

/// Collects the geoms, meshes and lamps of a procedural scene. Lengths in metres; each shape is given in a local frame
/// whose pose in the world is the last argument. Numbers are written the same way whatever the locale.
class MjcfWriter {
 public:
  /// A box with its corners at `low` and `high`, low < high in every coordinate.
  void box(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
           const Pose& world_from_local = {});
  void cylinder(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                const Pose& world_from_local = {});
  /// A cylinder with a half sphere beyond each of its ends.
  void capsule(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
               const Pose& world_from_local = {});
  void ellipsoid(const std::string& material, const Eigen::Vector3d& centre, const Eigen::Vector3d& semi_axes,
                 const Pose& world_from_local = {});
  void lamp(const Lamp& lamp) { lamps_.push_back(lamp); }
  void mesh(SceneMesh mesh);
  /// What is written until end_body() belongs to a body of its own, which a Mover can move.
  void begin_body(const std::string& name);
  void end_body();

  /// The scene so far, with those materials of the palette that it uses.
  /// @throws std::logic_error if a geom's material is not in the palette.
  SceneDescription finish(const std::string& model_name, const std::vector<Material>& palette, double ambient_lux,
                          double sky_luminance);

 private:
  void rod(const char* type, const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
           double radius_m, const Pose& world_from_local);
  void begin_geom(const char* type, const std::string& material);

  std::string geoms_;
  std::set<std::string> used_materials_;
  std::vector<Lamp> lamps_;
  std::vector<SceneMesh> meshes_;
};

/// A frame at a place of the world, turned about the vertical.
Pose upright_frame(const Eigen::Vector3d& origin_in_world, double yaw);

}  // namespace plumbline
