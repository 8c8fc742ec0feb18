#pragma once

#include <Eigen/Core>
#include <bitset>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/lidar/flat_index.h"
#include "estimator/lidar/point_tree.h"

namespace plumbline {

/// The map of one class of points (edges or planes) in two levels of voxels (thesis 5.3). Coarse voxels store the map,
/// at most one point a cell and side; each subdivides into 10 x 10 x 10 fine voxels, and only points in or beside fine
/// voxels that the scan hits enter its KD-tree.
class VoxelMap {
 public:
  /// @param resolution_m  edge of a cell: the map's density
  VoxelMap(double coarse_voxel_m, double resolution_m);

  /// Merges a point in W: its cell keeps the mean of the first points that fell into it, which cuts their noise.
  /// @param path_m  distance travelled so far
  void insert(const MapSample& point, float intensity, double path_m);

  /// Drops what was first seen before a path length.
  void forget_before(double path_m);

  /// Builds the trees that searches near these points need; nearest() sees what was inserted before.
  void prepare(const std::vector<Eigen::Vector3d>& points_in_world);
  void nearest(const Eigen::Vector3d& query_in_world, double largest_distance, NearestSamples& nearest) const;

  /// Appends everything that was inserted and not dropped, in the order of insertion of voxels and cells.
  void collect(std::vector<MapPoint>& points) const;

 private:
  static constexpr int kFine = 10;  // per axis

  struct Cell {
    MapSample mean;
    float intensity = 0.0F;
    int count = 0;
    double first_path_m = 0.0;
    std::uint64_t key = 0;
  };
  struct CoarseVoxel {
    Eigen::Vector3i at = Eigen::Vector3i::Zero();
    std::vector<Cell> cells;
    FlatIndex index;  // key -> position in cells
    double oldest_path_m = 0.0;
    PointTree tree;
    std::bitset<kFine * kFine * kFine> hit;      // fine voxels that the newest scan needs
    std::bitset<kFine * kFine * kFine> in_tree;  // fine voxels whose points the tree holds
    bool changed = false;                        // since the tree was built
  };

  CoarseVoxel* find(const Eigen::Vector3i& coarse);
  CoarseVoxel& find_or_create(const Eigen::Vector3i& coarse);
  void mark(const Eigen::Vector3i& fine);
  int fine_of(const CoarseVoxel& voxel, const Eigen::Vector3d& position) const;
  void rebuild_tree(CoarseVoxel& voxel) const;
  void drop_older(CoarseVoxel& voxel, double path_m);

  double coarse_m_;
  double resolution_m_;
  std::vector<CoarseVoxel> voxels_;
  FlatIndex voxel_index_;  // packed coarse cell -> position in voxels_
};

}  // namespace plumbline
