#include "estimator/lidar/range_bias.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// What the map holds of a ring was laid down with the bias that is looked for, so that a match sees only part of it,
// and what comes first is no better than what comes later: learning never stops.
constexpr double kLeastLeft = 0.3;
// Nor is a bias believed to be several times as large as its sigma: what a beam's width adds at grazing incidence looks
// like one, and differs from surface to surface.
constexpr double kMostBias = 3.0;

}  // namespace

LidarScan RangeBiases::taken_off(const LidarScan& scan) const {
  LidarScan unbiased = scan;
  for (LidarPoint& point : unbiased.points) {
    if (point.ring >= bias_m_.size()) continue;
    const float range_m = point.position.norm();
    const float bias_m = bias_m_[point.ring];
    if (range_m > bias_m) point.position *= 1.0F - bias_m / range_m;
  }
  return unbiased;
}

double RangeBiases::sigma_m(int ring) const {
  const auto at = static_cast<std::size_t>(ring);
  return at < left_m_.size() ? left_m_[at] : sigma_m_;
}

void RangeBiases::learn(const std::vector<SharedEstimate>& matched, double renewed) {
  // A bias that all share, as with a line scanner on a motor, is in the map, too: nothing can be told of it.
  if (matched.size() < 2) return;
  if (bias_m_.size() < matched.size()) {
    bias_m_.resize(matched.size(), 0.0F);
    left_m_.resize(matched.size(), sigma_m_);
  }
  for (std::size_t ring = 0; ring < matched.size(); ++ring) {
    const double variance = matched[ring].variance;
    if (!(variance > 0.0 && variance < 1.0) || !std::isfinite(matched[ring].mean)) continue;
    // What the match says without its prior, then with so much of its information.
    const double measured = matched[ring].mean / (1.0 - variance);
    const double information = renewed * (1.0 / variance - 1.0);
    const double step_m = left_m_[ring] * measured * information / (1.0 + information);
    bias_m_[ring] = static_cast<float>(std::clamp(bias_m_[ring] + step_m, -kMostBias * sigma_m_, kMostBias * sigma_m_));
    left_m_[ring] = std::max(kLeastLeft * sigma_m_, left_m_[ring] / std::sqrt(1.0 + information));
  }
}

}  // namespace plumbline
