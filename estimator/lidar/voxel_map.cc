#include "estimator/lidar/voxel_map.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "estimator/lidar/facing_side.h"

namespace plumbline {
namespace {

// After so many points a cell's mean stands: its noise is below the lidar's by sqrt(32), and a mean that went on moving
// would follow the estimate's drift, which the map is there to stop.
constexpr int kPointsPerMean = 32;

MapPoint exported(const MapSample& mean, float intensity) {
  MapPoint point{mean.position.cast<float>(), intensity};
  point.normal = mean.normal;
  point.normal.stableNormalize();
  return point;
}

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

VoxelMap::VoxelMap(double coarse_voxel_m, double resolution_m)
    : coarse_m_(coarse_voxel_m), resolution_m_(resolution_m) {}

VoxelMap::CoarseVoxel* VoxelMap::find(const Eigen::Vector3i& coarse) {
  const std::uint32_t at = voxel_index_.find(pack_cell(coarse));
  return at == FlatIndex::kAbsent ? nullptr : &voxels_[at];
}

VoxelMap::CoarseVoxel& VoxelMap::find_or_create(const Eigen::Vector3i& coarse) {
  const auto fresh = static_cast<std::uint32_t>(voxels_.size());
  const std::uint32_t at = voxel_index_.find_or_insert(pack_cell(coarse), fresh);
  if (at == fresh) {
    voxels_.emplace_back();
    voxels_.back().at = coarse;
    voxels_.back().oldest_path_m = std::numeric_limits<double>::infinity();
  }
  return voxels_[at];
}

void VoxelMap::insert(const MapSample& point, float intensity, double path_m) {
  if (!point.position.allFinite()) return;
  CoarseVoxel& voxel = find_or_create(cell_of(point.position, 1.0 / coarse_m_));
  const Eigen::Vector3d in_voxel = point.position - coarse_m_ * voxel.at.cast<double>();
  const std::uint64_t key = pack_cell(cell_of(in_voxel, 1.0 / resolution_m_), facing_side(point.normal));
  const auto fresh = static_cast<std::uint32_t>(voxel.cells.size());
  const std::uint32_t at = voxel.index.find_or_insert(key, fresh);
  if (at == fresh) {
    voxel.cells.push_back({point, intensity, 1, path_m, key});
    voxel.oldest_path_m = std::min(voxel.oldest_path_m, path_m);
    voxel.changed = true;
    return;
  }
  Cell& cell = voxel.cells[at];
  if (cell.count >= kPointsPerMean) return;
  const double share = 1.0 / ++cell.count;
  cell.mean.position += share * (point.position - cell.mean.position);
  cell.mean.normal += static_cast<float>(share) * (point.normal - cell.mean.normal);
  cell.intensity += static_cast<float>(share) * (intensity - cell.intensity);
  voxel.changed = true;
}

void VoxelMap::forget_before(double path_m) {
  for (CoarseVoxel& voxel : voxels_) {
    if (voxel.oldest_path_m < path_m) drop_older(voxel, path_m);
  }
}

void VoxelMap::drop_older(CoarseVoxel& voxel, double path_m) {
  std::vector<Cell> old;
  old.swap(voxel.cells);
  voxel.index.clear();
  voxel.oldest_path_m = std::numeric_limits<double>::infinity();
  voxel.changed = true;
  for (const Cell& cell : old) {
    if (cell.first_path_m < path_m) continue;
    voxel.index.find_or_insert(cell.key, static_cast<std::uint32_t>(voxel.cells.size()));
    voxel.cells.push_back(cell);
    voxel.oldest_path_m = std::min(voxel.oldest_path_m, cell.first_path_m);
  }
}

int VoxelMap::fine_of(const CoarseVoxel& voxel, const Eigen::Vector3d& position) const {
  const Eigen::Vector3d in_voxel = position - coarse_m_ * voxel.at.cast<double>();
  const Eigen::Array3i fine = cell_of(in_voxel, kFine / coarse_m_).array().max(0).min(kFine - 1);
  return (fine.x() * kFine + fine.y()) * kFine + fine.z();
}

void VoxelMap::mark(const Eigen::Vector3i& fine) {
  const Eigen::Vector3i coarse = fine.unaryExpr([](int v) { return floor_divide(v, kFine); });
  CoarseVoxel* voxel = find(coarse);
  if (voxel == nullptr) return;
  const Eigen::Vector3i local = fine - kFine * coarse;
  voxel->hit.set(static_cast<std::size_t>((local.x() * kFine + local.y()) * kFine + local.z()));
}

void VoxelMap::prepare(const std::vector<Eigen::Vector3d>& points_in_world) {
  for (CoarseVoxel& voxel : voxels_) voxel.hit.reset();
  FlatIndex first_in_fine(points_in_world.size());
  for (std::uint32_t i = 0; i < points_in_world.size(); ++i) {
    const Eigen::Vector3i fine = cell_of(points_in_world[i], kFine / coarse_m_);
    if (first_in_fine.find_or_insert(pack_cell(fine), i) != i) continue;
    for (int k = 0; k < 27; ++k) mark(fine + Eigen::Vector3i(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1));
  }
  for (CoarseVoxel& voxel : voxels_) {
    const bool misses_points = (voxel.hit & ~voxel.in_tree).any();
    if (misses_points || (voxel.changed && voxel.hit.any())) rebuild_tree(voxel);
  }
}

void VoxelMap::rebuild_tree(CoarseVoxel& voxel) const {
  std::vector<MapSample> samples;
  samples.reserve(voxel.cells.size());
  for (const Cell& cell : voxel.cells) {
    if (voxel.hit.test(static_cast<std::size_t>(fine_of(voxel, cell.mean.position)))) samples.push_back(cell.mean);
  }
  for (MapSample& sample : samples) sample.normal.stableNormalize();
  voxel.tree.build(std::move(samples));
  voxel.in_tree = voxel.hit;
  voxel.changed = false;
}

void VoxelMap::nearest(const Eigen::Vector3d& query, double largest_distance, NearestSamples& nearest) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(largest_distance);
  const Eigen::Vector3i low = cell_of(query - reach, 1.0 / coarse_m_);
  const Eigen::Vector3i high = cell_of(query + reach, 1.0 / coarse_m_);
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        const std::uint32_t at = voxel_index_.find(pack_cell({x, y, z}));
        if (at != FlatIndex::kAbsent) voxels_[at].tree.search(query, nearest);
      }
    }
  }
}

void VoxelMap::collect(std::vector<MapPoint>& points) const {
  for (const CoarseVoxel& voxel : voxels_) {
    for (const Cell& cell : voxel.cells) points.push_back(exported(cell.mean, cell.intensity));
  }
}

}  // namespace plumbline
