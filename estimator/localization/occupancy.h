#pragma once

#include "estimator/lidar/features.h"
#include "estimator/lidar/flat_index.h"

namespace plumbline {

/// Which cells of space hold a surface of a map, or have a neighbour that does: whether a map says anything at a place
/// at all.
class Occupancy {
 public:
  static constexpr double kCell_m = 1.5;  ///< as far as the matcher looks

  explicit Occupancy(const FeatureCloud& surfaces);

  bool near(const Eigen::Vector3d& place) const {
    return index_.find(pack_cell(cell_of(place, 1.0 / kCell_m))) != FlatIndex::kAbsent;
  }
  /// Share of a cloud's planes and edges that are near, of at most a few thousand evenly picked.
  double share_near(const FeatureCloud& features, const Pose& map_from_features) const;

 private:
  void mark(const Eigen::Vector3i& cell);

  FlatIndex index_;
};

}  // namespace plumbline
