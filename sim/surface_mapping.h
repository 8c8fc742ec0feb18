#pragma once

#include <Eigen/Core>
#include <cstdint>

struct mjModel_;

namespace plumbline {

/// Where a point of a geom lies on the two textures of its material, in tiles: (structure, wear). Lengths are true to
/// the world's metre on boxes and planes; curved surfaces and terrain are mapped along their dominant world axis, which
/// keeps neighbouring faces together and stretches by up to sqrt(3).
class SurfaceMapping {
 public:
  /// Each geom, and each side of it, shows another part of the textures, drawn from the seed.
  SurfaceMapping(const mjModel_& model, int geom, std::uint64_t world_seed);

  /// The mapping of one face.
  class Face {
   public:
    Eigen::Vector4d operator()(const Eigen::Vector3d& point_in_world) const {
      return tiles_from_world_ * point_in_world + offset_;
    }

   private:
    friend class SurfaceMapping;
    Eigen::Matrix<double, 4, 3> tiles_from_world_;
    Eigen::Vector4d offset_;
  };
  Face face(const Eigen::Vector3d& normal_in_world) const;

 private:
  bool flat_sided_ = false;
  std::uint64_t seed_ = 0;
};

}  // namespace plumbline
