#include "sim/vehicles/wind.h"

#include <cmath>

#include "sim/vehicles/rotor_craft.h"

namespace plumbline {

Wind::Wind(double mean_mps, std::uint64_t seed) : stream_(seed, "wind"), mean_mps_(mean_mps) {
  const double from = stream_.uniform(0.0, 2.0 * M_PI);
  mean_ = mean_mps * Eigen::Vector3d(std::cos(from), std::sin(from), 0.0);
}

Eigen::Vector3d Wind::next() {
  constexpr double kStep_s = RotorCraft::kStep_s;
  constexpr double kCorrelation_s = 1.5;
  constexpr double kGusts = 0.2;
  const double drive = kGusts * mean_mps_ * std::sqrt(2.0 * kStep_s / kCorrelation_s);
  for (double& gust : gust_) gust += -gust * kStep_s / kCorrelation_s + drive * stream_.gaussian();
  return mean_ + gust_;
}

}  // namespace plumbline
