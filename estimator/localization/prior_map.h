#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/flat_index.h"

namespace plumbline {

/// A map made earlier, by us or by anybody, as matching needs it.
struct PriorMap {
  /// In the map's frame. Planes have unit normals; where the map did not say from which side a surface was seen, each
  /// point is there for both.
  FeatureCloud surfaces;
  /// The points themselves, thinned; their normals as the map gave them.
  std::vector<MapPoint> thinned;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< the corners of its extent
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< [m]
  std::int64_t points = 0;                         ///< taken in, of any number
  std::int64_t unusable = 0;                       ///< left out: not finite
  double cell_m = 0.0;                             ///< thinned to one point a cell and side

  /// Distance from a place to the map's nearest point. @return infinity for a map without points
  double distance(const Eigen::Vector3d& place) const;
};

/// Takes a map in point by point and keeps one mean a cell, so that its memory depends on the surface that the map
/// covers and not on how many points cover it: at most kMostCells, which with all that is built on them is under 1 GB.
/// A map that needs more gets cells of twice the size, up to kLargestCell_m.
class PriorMapBuilder {
 public:
  static constexpr std::size_t kMostCells = 2'000'000;
  static constexpr double kLargestCell_m = 0.8;
  static constexpr double kLargestCoordinate_m =
      10'000.0;  ///< beyond, single precision resolves less than a millimetre

  /// @param has_normals  zero normals are edges, unless all are zero; otherwise they are found from the neighbours
  explicit PriorMapBuilder(bool has_normals);

  /// @throws std::invalid_argument for a place beyond kLargestCoordinate_m or a map too large
  void add(const Eigen::Vector3d& position, const Eigen::Vector3f& normal, float intensity);

  /// The builder is used up. @throws std::invalid_argument if there was no usable point
  PriorMap build();

 private:
  struct Cell {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float intensity = 0.0F;
    float count = 0.0F;
  };

  void merge(const Cell& cell);
  void coarsen();
  void keep_points();
  void take_normals_as_given(FeatureCloud& surfaces) const;
  void find_normals(FeatureCloud& surfaces) const;

  bool has_normals_;
  bool any_normal_ = false;
  PriorMap map_;
  std::vector<Cell> cells_;
  FlatIndex index_;
};

}  // namespace plumbline
