#pragma once

#include <vector>

#include "estimator/messages.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// The range bias of each ring, learnt while matching. Calibrations leave a centimetre of it (Glennie and Lichti,
/// Remote Sensing 2(6), 2010), constant for hours, and what it bends never averages out: along a smooth tunnel, where
/// each ring is first to see the ground at its own distance ahead, it turns pitch by tenths of a degree in a hundred
/// metres.
class RangeBiases {
 public:
  /// @param sigma_m  of a ring's bias, as long as nothing is learnt
  explicit RangeBiases(double sigma_m) : sigma_m_(sigma_m) {}

  /// The scan without what is known of its biases.
  LidarScan taken_off(const LidarScan& scan) const;

  /// [m], by ring; of rings beyond its end nothing is known yet.
  const std::vector<float>& metres() const { return bias_m_; }
  /// [m] of what is left.
  double sigma_m(int ring) const;

  /// @param matched  by ring, what a match says of the biases left, in units of sigma_m
  /// @param renewed  [0, 1] share of what is matched that the match before did not see: all else it only repeats
  void learn(const std::vector<SharedEstimate>& matched, double renewed);

 private:
  double sigma_m_;
  std::vector<float> bias_m_;
  std::vector<double> left_m_;  ///< sigma of what is left
};

}  // namespace plumbline
