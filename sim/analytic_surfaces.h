#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace plumbline {

/// A surface that rays meet in closed form, in the sizes of MuJoCo's geom types (mjModel::geom_size).
struct AnalyticSurface {
  enum class Kind {
    kPlane,      ///< half x, half y, 0 or less: infinite along that axis; seen from +z only, as mj_ray has it
    kSphere,     ///< radius
    kCapsule,    ///< radius, half length of the cylindrical part along z
    kEllipsoid,  ///< semi-axes
    kCylinder    ///< radius, half length along z
  };

  Kind kind = Kind::kSphere;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  Eigen::Matrix3d world_from_geom_rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  int geom = -1;
};

struct SurfaceHit {
  double range_m = 0.0;
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::UnitZ();  ///< unit, outward
};

/// False for planes that are infinite along an axis.
bool is_bounded(const AnalyticSurface& surface);

/// Axis-aligned, of a bounded surface.
Eigen::AlignedBox3d bounds_in_world(const AnalyticSurface& surface);

/// The first crossing of the surface in [min_range_m, max_range_m]; from inside a solid that is where the ray leaves
/// it.
/// @param direction_in_world  unit length
std::optional<SurfaceHit> intersect(const AnalyticSurface& surface, const Eigen::Vector3d& origin_in_world,
                                    const Eigen::Vector3d& direction_in_world, double min_range_m, double max_range_m);

/// Distance to the nearest point of the surface, from either side.
double distance(const AnalyticSurface& surface, const Eigen::Vector3d& point_in_world);

}  // namespace plumbline
