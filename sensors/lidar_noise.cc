#include "sensors/lidar_noise.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

double gaussian_quantile_in_tail(double probability, double q) {
  double r = std::sqrt(-std::log(std::min(probability, 1.0 - probability)));
  double quantile = 0.0;
  if (r <= 5.0) {
    r -= 1.6;
    quantile = (((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777) /
               ((0.12021132975 * r + 0.73700164250) * r + 1.0);
  } else {
    r -= 5.0;
    quantile = (((0.017337203997 * r + 0.42868294337) * r + 3.0812263860) * r + 6.6579051150) /
               ((0.012258202635 * r + 0.24197894225) * r + 1.0);
  }
  return q < 0.0 ? -quantile : quantile;
}

}  // namespace plumbline
