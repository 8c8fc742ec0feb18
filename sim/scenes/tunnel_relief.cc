#include "sim/scenes/tunnel_relief.h"

#include <cmath>

#include "sim/random_stream.h"
#include "sim/scenes/ribbon.h"

namespace plumbline {
namespace {

constexpr double kCoarse_m = 1.5;
constexpr double kFine_m = 0.75;
constexpr double kCoarseShare = 0.8;  // of the deviation; the squares add up to 1
constexpr double kFineShare = 0.6;
// The deviation of smooth_noise: uniform values in [-1, 1], weighted with (1 - e)^2 + e^2 along both axes, whose mean
// over e = 3 t^2 - 2 t^3 is 26 / 35.
const double kNoiseDeviation = 26.0 / 35.0 / std::sqrt(3.0);

}  // namespace

TunnelRelief::TunnelRelief(const TunnelPlan& plan, const std::vector<TunnelStrip>& lining)
    : roughness_(plan.roughness),
      middle_height_(plan.height / 2.0),
      mean_radius_((plan.half_width + plan.height / 2.0) / 2.0),
      coarse_seed_(derive_seed(plan.seed, "tunnel/relief/coarse")),
      fine_seed_(derive_seed(plan.seed, "tunnel/relief/fine")),
      lining_(lining) {}

Eigen::Vector2d TunnelRelief::inward(const Eigen::Vector2d& point) const {
  constexpr double kOnStrip_m = 1e-6;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const TunnelStrip& strip : lining_) {
    const Eigen::Vector2d from_middle = point - strip.middle;
    const bool beside = std::abs(from_middle.dot(strip.across())) > strip.width / 2.0 + kOnStrip_m;
    if (!beside && std::abs(from_middle.dot(strip.normal())) < kOnStrip_m) sum += strip.normal();
  }
  return sum.normalized();
}

Eigen::Vector2d TunnelRelief::displaced(double s, const Eigen::Vector2d& point) const {
  if (roughness_ <= 0.0) return point;
  // Around the section; what little the seam below the road jumps is not seen.
  const double around = mean_radius_ * std::atan2(point.x(), point.y() - middle_height_);
  const double noise = kCoarseShare * smooth_noise(coarse_seed_, s / kCoarse_m, around / kCoarse_m) +
                       kFineShare * smooth_noise(fine_seed_, s / kFine_m, around / kFine_m);
  return point + roughness_ / kNoiseDeviation * noise * inward(point);
}

}  // namespace plumbline
