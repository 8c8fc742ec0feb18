#include "estimator/localization/prior_map.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/facing_side.h"
#include "estimator/lidar/voxel_map.h"

namespace plumbline {
namespace {

// Our own maps keep edges a decimetre apart. Ten neighbours that tell a normal have to span more than the noise.
constexpr double kCellWithNormals_m = 0.1;
constexpr double kCellWithoutNormals_m = 0.2;
constexpr double kCoarseVoxel_m = 10.0;
constexpr int kNormalNeighbours = 10;

/// Normals tell one surface from another that stands across it; the planes to match are fitted later.
FitLimits normal_limits(double cell_m) {
  FitLimits limits;
  limits.least_spread_m = 0.3 * cell_m;
  limits.largest_tilt_sigma = 0.2;
  return limits;
}

}  // namespace

double PriorMap::distance(const Eigen::Vector3d& place) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto* kind : {&surfaces.planes, &surfaces.edges}) {
    for (const FeaturePoint& f : *kind) nearest = std::min(nearest, (f.position.cast<double>() - place).norm());
  }
  return nearest;
}

PriorMapBuilder::PriorMapBuilder(bool has_normals) : has_normals_(has_normals) {
  map_.cell_m = has_normals ? kCellWithNormals_m : kCellWithoutNormals_m;
  map_.low.setConstant(std::numeric_limits<double>::infinity());
  map_.high = -map_.low;
}

void PriorMapBuilder::add(const Eigen::Vector3d& position, const Eigen::Vector3f& normal, float intensity) {
  if (!position.allFinite() || !normal.allFinite()) {
    ++map_.unusable;
    return;
  }
  if (position.cwiseAbs().maxCoeff() > kLargestCoordinate_m) {
    throw std::invalid_argument("a point lies " + std::to_string(std::lround(position.norm())) +
                                " m from the origin; allowed is " + std::to_string(std::lround(kLargestCoordinate_m)) +
                                " m along each axis: metres, in a local frame");
  }
  ++map_.points;
  map_.low = map_.low.cwiseMin(position);
  map_.high = map_.high.cwiseMax(position);
  any_normal_ = any_normal_ || normal.squaredNorm() > 0.0F;
  const bool is_edge = !has_normals_ || normal.squaredNorm() < 0.25F;
  merge({position.cast<float>(), is_edge ? Eigen::Vector3f::Zero() : Eigen::Vector3f(normal.normalized()),
         std::isfinite(intensity) ? intensity : 0.0F, 1.0F});
  if (cells_.size() > kMostCells) coarsen();
}

void PriorMapBuilder::merge(const Cell& cell) {
  const Eigen::Vector3i at = cell_of(cell.position.cast<double>(), 1.0 / map_.cell_m);
  const auto fresh = static_cast<std::uint32_t>(cells_.size());
  const std::uint32_t found = index_.find_or_insert(pack_cell(at, facing_side(cell.normal)), fresh);
  if (found == fresh) {
    cells_.push_back(cell);
    return;
  }
  Cell& mean = cells_[found];
  mean.count += cell.count;
  const float share = cell.count / mean.count;
  mean.position += share * (cell.position - mean.position);
  mean.normal += share * (cell.normal - mean.normal);
  mean.intensity += share * (cell.intensity - mean.intensity);
}

void PriorMapBuilder::coarsen() {
  map_.cell_m *= 2.0;
  if (map_.cell_m > kLargestCell_m) {
    throw std::invalid_argument("it covers more than " + std::to_string(kMostCells) + " cells of " +
                                std::to_string(kLargestCell_m) + " m; give a part of it");
  }
  std::vector<Cell> fine;
  fine.swap(cells_);
  index_ = FlatIndex(fine.size() / 2);
  for (const Cell& cell : fine) merge(cell);
  if (cells_.size() > kMostCells) coarsen();
}

PriorMap PriorMapBuilder::build() {
  if (map_.points == 0) {
    throw std::invalid_argument(map_.unusable == 0 ? "it has no points" : "none of its points is finite");
  }
  keep_points();
  if (has_normals_ && any_normal_) {
    take_normals_as_given(map_.surfaces);
  } else {
    find_normals(map_.surfaces);
  }
  return std::move(map_);
}

void PriorMapBuilder::keep_points() {
  map_.thinned.reserve(cells_.size());
  for (const Cell& cell : cells_) {
    map_.thinned.push_back({cell.position, cell.intensity});
    map_.thinned.back().normal = cell.normal;
    map_.thinned.back().normal.stableNormalize();
  }
}

void PriorMapBuilder::take_normals_as_given(FeatureCloud& surfaces) const {
  for (const Cell& cell : cells_) {
    FeaturePoint point{cell.position, cell.intensity};
    point.normal = cell.normal;
    point.normal.stableNormalize();
    (facing_side(point.normal) == 6 ? surfaces.edges : surfaces.planes).push_back(point);
  }
}

void PriorMapBuilder::find_normals(FeatureCloud& surfaces) const {
  VoxelMap all(kCoarseVoxel_m, map_.cell_m);
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(cells_.size());
  for (const Cell& cell : cells_) {
    positions.push_back(cell.position.cast<double>());
    all.insert({positions.back(), Eigen::Vector3f::Zero()}, 0.0F, 0.0);
  }
  all.prepare(positions);
  const FitLimits limits = normal_limits(map_.cell_m);
  const double reach_m = 5.0 * map_.cell_m;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    NearestSamples nearest(kNormalNeighbours, reach_m, Eigen::Vector3f::Zero());
    all.nearest(positions[i], reach_m, nearest);
    const auto plane = fit_plane(nearest, limits, positions[i]);
    if (!plane) continue;
    FeaturePoint point{cells_[i].position, cells_[i].intensity};
    point.normal = plane->normal.cast<float>();
    surfaces.planes.push_back(point);
    point.normal = -point.normal;
    surfaces.planes.push_back(point);
  }
}

}  // namespace plumbline
