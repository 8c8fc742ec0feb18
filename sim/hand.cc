#include "sim/hand.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimator/geometry/so3.h"
#include "sim/constants.h"

namespace plumbline {
namespace {

const Eigen::Vector3d kBodyFromWrist{0.12, 0.0, 0.05};  // where the body sits, seen from the wrist [m]

Eigen::Vector3d values_of(const std::vector<SmoothNoise>& noise, std::size_t first, double time_s) {
  return {noise[first].at(time_s), noise[first + 1].at(time_s), noise[first + 2].at(time_s)};
}

/// Peak over mean of magnitudes raised to a power, each times its share.
double peak_over_mean(const std::vector<double>& magnitude, const std::vector<double>& share, double power) {
  double sum = 0.0;
  double peak = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < magnitude.size(); ++i) {
    if (share[i] <= 0.0) continue;
    const double value = share[i] * std::pow(magnitude[i], power);
    sum += value;
    peak = std::max(peak, value);
    count += 1.0;
  }
  return count > 0.0 && sum > 0.0 ? peak * count / sum : 1.0;
}

}  // namespace

HandWander::HandWander(double deviation_deg, std::uint64_t seed) : deviation_(deviation_deg * kDegree) {
  RandomStream stream(seed, "hand wander");
  for (int i = 0; i < 6; ++i) noise_.emplace_back(stream, 0.05, 0.8);
}

Pose HandWander::at(double time_s, double share) const {
  constexpr double kForearm_m = 0.3;  // what turns by so much also moves by so much
  return {exp_so3(share * deviation_ * values_of(noise_, 0, time_s)),
          kForearm_m * share * deviation_ * values_of(noise_, 3, time_s)};
}

HandSpin::HandSpin(const MotionConfig& config, std::vector<double> share, std::uint64_t seed)
    : share_(std::move(share)) {
  if (config.spin_mean_dps <= 0.0) return;
  constexpr double kLeastPower = 0.3;
  constexpr double kMostPower = 6.0;
  RandomStream stream(seed, "hand spin");
  for (int i = 0; i < 3; ++i) noise_.emplace_back(stream, 0.3, 1.3);
  std::vector<double> magnitude;
  for (std::size_t i = 0; i < share_.size(); ++i) {
    magnitude.push_back(values_of(noise_, 0, static_cast<double>(i) * kStep_s).norm());
  }
  // The more the magnitude is stretched, the further its peak stands out.
  const double wanted = config.spin_peak_dps / config.spin_mean_dps;
  double low = kLeastPower;
  double high = kMostPower;
  if (wanted < peak_over_mean(magnitude, share_, low) || wanted > peak_over_mean(magnitude, share_, high)) {
    throw std::invalid_argument("motion: spin: peak_deg_per_s must be about 2 to 10 times mean_deg_per_s");
  }
  for (int i = 0; i < 50; ++i) {
    power_ = 0.5 * (low + high);
    (peak_over_mean(magnitude, share_, power_) < wanted ? low : high) = power_;
  }
  double peak = 0.0;
  for (std::size_t i = 0; i < magnitude.size(); ++i) {
    peak = std::max(peak, share_[i] * std::pow(magnitude[i], power_));
  }
  scale_ = config.spin_peak_dps * kDegree / peak;
}

Eigen::Vector3d HandSpin::rate(double time_s) const {
  const double place = std::clamp(time_s / kStep_s, 0.0, static_cast<double>(share_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), share_.size() - 2);
  const double u = place - static_cast<double>(i);
  const double share = (1.0 - u) * share_[i] + u * share_[i + 1];
  const Eigen::Vector3d noise = values_of(noise_, 0, time_s);
  const double magnitude = noise.norm();
  if (magnitude <= 0.0) return Eigen::Vector3d::Zero();
  return scale_ * share * std::pow(magnitude, power_ - 1.0) * noise;
}

void HandSpin::advance(double time_s, double dt_s) {
  if (scale_ == 0.0) return;
  attitude_ = (attitude_ * exp_so3(dt_s * rate(time_s - 0.5 * dt_s))).normalized();
}

Pose HandSpin::pose() const { return {attitude_, attitude_ * kBodyFromWrist - kBodyFromWrist}; }

}  // namespace plumbline
