#pragma once

#include <map>
#include <string>

#include "sensors/lidar.h"

/// The errors of a lidar's returns against the configured model.
namespace plumbline {

/// A floor below, seen by one beam: every firing has the same range and the same angle of incidence.
struct LidarTarget {
  double range_m = 10.0;
  double incidence_deg = 0.0;  ///< below 89.9
  float reflectivity = 0.5F;
};

/// What a beam of a device reports of a target, and what the device's model expects.
struct TargetReturns {
  double firings = 0.0;
  double sigma_m = 0.0;  ///< of the ranges that return, quantisation left out
  double expected_sigma_m = 0.0;
  double share = 0.0;  ///< of the firings that return
  double expected_share = 0.0;
};
TargetReturns returns_of(const LidarModel& device, const LidarTarget& target);

/// Range noise, drop-out and mixed pixels as statistics: of each check the probability of a deviation as large by
/// chance. Judged together: by Bonferroni's inequality the least of n lies below p / n with a probability of p.
std::map<std::string, double> lidar_effect_chances();

}  // namespace plumbline
