#pragma once

#include <Eigen/Core>

#include "sim/random_stream.h"

namespace plumbline {

/// A mean wind with gusts of a fifth of it (a first-order Markov process, as MIL-F-8785C's Dryden model is along it),
/// from a side that the seed chooses.
class Wind {
 public:
  Wind(double mean_mps, std::uint64_t seed);

  /// The air's velocity in the world [m/s], RotorCraft::kStep_s after the one before.
  Eigen::Vector3d next();

 private:
  RandomStream stream_;
  double mean_mps_;
  Eigen::Vector3d mean_;
  Eigen::Vector3d gust_ = Eigen::Vector3d::Zero();
};

}  // namespace plumbline
