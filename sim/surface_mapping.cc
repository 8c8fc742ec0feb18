#include "sim/surface_mapping.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "sim/random_stream.h"
#include "sim/textures.h"

namespace plumbline {
namespace {

int dominant_axis(const Eigen::Vector3d& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// Right and down as seen by someone in front of the face (on floors and ceilings: world x, and what it leaves).
Eigen::Matrix<double, 2, 3> right_and_down(const Eigen::Vector3d& normal) {
  constexpr double kLevel = 0.9;
  const Eigen::Vector3d right = std::abs(normal.z()) > kLevel
                                    ? (Eigen::Vector3d::UnitX() - normal.x() * normal).normalized()
                                    : Eigen::Vector3d::UnitZ().cross(normal).normalized();
  Eigen::Matrix<double, 2, 3> axes;
  axes.row(0) = right;
  axes.row(1) = right.cross(normal);
  return axes;
}

}  // namespace

SurfaceMapping::SurfaceMapping(const mjModel& model, int geom, std::uint64_t world_seed)
    : flat_sided_(model.geom_type[geom] == mjGEOM_BOX || model.geom_type[geom] == mjGEOM_PLANE),
      seed_(derive_seed(world_seed, "surface " + std::to_string(geom))) {}

SurfaceMapping::Face SurfaceMapping::face(const Eigen::Vector3d& normal_in_world) const {
  const int axis = dominant_axis(normal_in_world);
  const double sign = normal_in_world[axis] < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d axis_normal = sign * Eigen::Vector3d::Unit(axis);
  const Eigen::Matrix<double, 2, 3> axes = right_and_down(flat_sided_ ? normal_in_world : axis_normal);

  Face face;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(kWearAngle_rad).toRotationMatrix();
  face.tiles_from_world_.topRows<2>() = axes / kStructurePeriod_m;
  face.tiles_from_world_.bottomRows<2>() = turn * axes / kWearPeriod_m;
  const auto side = static_cast<std::uint64_t>(2 * axis + (sign < 0.0 ? 1 : 0));
  for (std::uint64_t i = 0; i < 4; ++i) {
    face.offset_[static_cast<Eigen::Index>(i)] =
        static_cast<double>(mix_bits(seed_ ^ (4 * side + i)) >> 11) * 0x1.0p-53;
  }
  return face;
}

}  // namespace plumbline
