#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/world.h"

namespace plumbline {

/// Collects scenery as triangles and hands them over as one mesh for each material and tile of the ground, so that a
/// scene of a million parts is a few meshes, each near one place. Points are in the world unless a frame is given
/// [m]; corners run counter-clockwise seen from outside.
class Scenery {
 public:
  explicit Scenery(double tile_m = 64.0) : tile_m_(tile_m) {}

  void triangle(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c);
  void quad(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
            const Eigen::Vector3d& d);
  /// A thin thing, seen from both sides whatever its material. (Leaves are single triangles of two-sided materials.)
  void sheet(const std::string& material, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d);

  /// A box with its corners at `low` and `high` of a frame.
  void box(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
           const Pose& world_from_local = {});
  /// The same without its underside, for what stands in the ground.
  void block(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             const Pose& world_from_local = {});
  /// A tapering rod of regular polygons, open at its ends.
  void rod(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double from_radius_m,
           double to_radius_m, int sides);
  /// A convex polygon in the x-z plane of a frame, extruded along y from y0 < y1; corners counter-clockwise with x to
  /// the right and z up.
  void prism(const std::string& material, const std::vector<Eigen::Vector2d>& profile, double y0, double y1,
             const Pose& world_from_local = {});

  std::size_t triangle_count() const { return triangle_count_; }

  /// Hands over everything collected, ordered by material and tile. Where a material is rare, four times four tiles
  /// share a mesh.
  std::vector<SceneMesh> take_meshes();

 private:
  using Key = std::tuple<int, int, int>;  // material, tile

  SceneMesh& batch(const std::string& material, const Eigen::Vector3d& place);
  void add(SceneMesh& mesh, std::initializer_list<Eigen::Vector3d> corners,
           std::initializer_list<std::array<std::uint32_t, 3>> triangles);
  void box_sides(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                 const Pose& world_from_local, bool with_bottom);

  double tile_m_;
  std::map<std::string, int> material_ids_;
  std::map<Key, SceneMesh> batches_;
  std::size_t triangle_count_ = 0;
};

}  // namespace plumbline
