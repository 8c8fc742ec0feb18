#include "estimator/localize.h"

#include <utility>

#include "estimator/localization/localized_estimator.h"

namespace plumbline {

std::unique_ptr<Estimator> make_localized_estimator(std::unique_ptr<Estimator> odometry, const Calibration& calibration,
                                                    const std::vector<MapPoint>& map, const Pose& map_from_start) {
  PriorMapBuilder builder(/*has_normals=*/true);
  for (const MapPoint& point : map) builder.add(point.position.cast<double>(), point.normal, point.intensity);
  LocalizationConfig config;
  config.map_from_start = map_from_start;
  return std::make_unique<LocalizedEstimator>(std::move(odometry), calibration, builder.build(), config);
}

}  // namespace plumbline
