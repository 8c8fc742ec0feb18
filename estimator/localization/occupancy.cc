#include "estimator/localization/occupancy.h"

#include <algorithm>

namespace plumbline {
namespace {
constexpr int kHolds = 1;  // label of cells that hold a surface themselves
constexpr std::size_t kSample = 2000;
}  // namespace

Occupancy::Occupancy(const FeatureCloud& surfaces) {
  for (const auto* kind : {&surfaces.planes, &surfaces.edges}) {
    for (const FeaturePoint& f : *kind) mark(cell_of(f.position.cast<double>(), 1.0 / kCell_m));
  }
}

void Occupancy::mark(const Eigen::Vector3i& cell) {
  if (index_.find(pack_cell(cell, kHolds)) != FlatIndex::kAbsent) return;
  index_.find_or_insert(pack_cell(cell, kHolds), 1);
  for (int k = 0; k < 27; ++k) {
    index_.find_or_insert(pack_cell(cell + Eigen::Vector3i(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1)), 1);
  }
}

double Occupancy::share_near(const FeatureCloud& features, const Pose& map_from_features) const {
  std::size_t taken = 0;
  std::size_t found = 0;
  for (const auto* kind : {&features.planes, &features.edges}) {
    const std::size_t step = std::max<std::size_t>(1, kind->size() / kSample);
    for (std::size_t i = 0; i < kind->size(); i += step) {
      ++taken;
      if (near(map_from_features * (*kind)[i].position.cast<double>())) ++found;
    }
  }
  return taken == 0 ? 0.0 : static_cast<double>(found) / static_cast<double>(taken);
}

}  // namespace plumbline
