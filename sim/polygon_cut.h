#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

namespace plumbline {

using Polygon = std::vector<Eigen::Vector3d>;  ///< convex and flat
using CellVisitor = std::function<void(const Eigen::Vector3i& cell, const Polygon& piece)>;

/// Cuts a polygon along the planes x, y, z = k * cell_m; cell (i, j, k) begins at (i, j, k) * cell_m. Two polygons that
/// share an edge get the same new corners on it, bit for bit, so that no crack opens between them.
void cut_into_cells(const Polygon& polygon, double cell_m, const CellVisitor& visit);

/// Keeps what lies above a rectangle of the plan. Polygons that share an edge keep sharing its new corners.
void clip_to_plan(const Eigen::AlignedBox2d& plan, Polygon& polygon);

}  // namespace plumbline
