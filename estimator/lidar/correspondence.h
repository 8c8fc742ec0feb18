#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/lidar/point_tree.h"
#include "estimator/solver/robust_solver.h"

/// From map points around a feature to the line or plane that it should lie on, and the rows of that constraint.
namespace plumbline {

/// Two range errors meet in a residual, the scan's and the map's. Below two centimetres the map's own errors (cells
/// that straddle a crease, curved surfaces, de-skewing) outweigh the lidar's noise.
inline constexpr double kLeastMatchSigma_m = 0.02;
/// Ten cells around a point of a wall span 0.8 m and average the noise of its normal; edges need a few more, since the
/// neighbours of one line mix with those of the next.
inline constexpr int kPlaneNeighbours = 10;
inline constexpr int kLineNeighbours = 16;

/// Enough to tell what fills space from a sheet.
inline constexpr int kClutterNeighbours = 8;
inline constexpr double kClutterReach_m = 0.5;
/// What a return of foliage lies off the nearest map point, which another beam left.
inline constexpr double kClutterSigma_m = 0.1;

/// The plane { x : normal . x = offset } in W.
struct MapPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
};

/// A line in W by a point and two unit vectors across it.
struct MapLine {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d across_1 = Eigen::Vector3d::UnitX();
  Eigen::Vector3d across_2 = Eigen::Vector3d::UnitY();
};

/// What the eigen test of the neighbours' scatter asks for (thesis 5.3: one small and two large eigenvalues make a
/// plane, one large and two small a line).
struct FitLimits {
  int least_neighbours = 5;
  double ratio = 9.0;  ///< of scatter eigenvalues, "much larger"
  double largest_residual_m = 0.08;
  double least_spread_m = 0.12;           ///< standard deviation along each large direction
  double map_sigma_m = 0.006;             ///< noise of a map point, at least
  double largest_tilt_sigma = 0.03;       ///< [rad] of the fitted normal or direction
  double largest_offset_sigma_m = 0.005;  ///< of a plane where it is used, by its tilt: a quarter of a match's sigma,
                                          ///< since all of a ring's points may share it
  /// [rad] between a plane's normal and the mean of its neighbours' own. Where a beam grazes, range noise is the
  /// largest spread across a ring, and the plane through a single ring's points contains the beam.
  double largest_disagreement = 1.0;
};

/// @param used_at  the point in W that the plane is to tell something of
std::optional<MapPlane> fit_plane(const NearestSamples& neighbours, const FitLimits& limits,
                                  const Eigen::Vector3d& used_at);
std::optional<MapLine> fit_line(const NearestSamples& neighbours, const FitLimits& limits);

/// Where the neighbours fill space, the line through the nearest of them along `unseen`, the direction across the beams
/// in which the scan's own spacing says nothing about what was met. Points of a smooth surface have none: the nearest
/// to each is one that the same beam left, and would hold the pose where it is along the surface.
std::optional<MapLine> line_through_clutter(const NearestSamples& neighbours, const Eigen::Vector3d& unseen);

/// Distance to the plane (5.15), signed so that it is smooth at zero, over sigma.
void add_plane_row(const Eigen::Vector3d& point_in_body, const MapPlane& plane, const Pose& world_from_body,
                   double sigma_m, ResidualRows& rows);

/// Offset from the line (5.14) as its two components across the line, over sigma: their norm has no derivative at zero.
void add_line_rows(const Eigen::Vector3d& point_in_body, const MapLine& line, const Pose& world_from_body,
                   double sigma_m, ResidualRows& rows);

}  // namespace plumbline
