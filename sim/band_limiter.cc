#include "sim/band_limiter.h"

#include <cmath>

namespace plumbline {
namespace {

constexpr std::ptrdiff_t kReach = 10;  // over four standard deviations

}  // namespace

BandLimiter::BandLimiter(std::int64_t first_ns) : first_ns_(first_ns) {
  // The transform of a Gaussian of deviation s is exp(-2 (pi s f)^2), and -3 dB is 1 / sqrt(2).
  const double sigma_s = std::sqrt(std::log(2.0) / 4.0) / (M_PI * kCutoff_hz);
  double sum = 0.0;
  for (std::ptrdiff_t i = -kReach; i <= kReach; ++i) {
    const double t = static_cast<double>(i) * kStep_s / sigma_s;
    kernel_.push_back(std::exp(-0.5 * t * t));
    sum += kernel_.back();
  }
  for (double& weight : kernel_) weight /= sum;
}

void BandLimiter::add(const Pose& pose) {
  Channels channels;
  channels << pose.translation, pose.rotation.coeffs();
  if (recent_.empty()) {
    recent_.assign(kernel_.size(), channels);
    pushed_ = kReach;  // the first pose is held before the start
  }
  push(channels);
}

void BandLimiter::push(const Channels& channels) {
  const std::size_t size = kernel_.size();
  const auto at = [&](std::int64_t i) -> Channels& { return recent_[static_cast<std::size_t>(i) % size]; };
  at(pushed_) = channels;
  // q and -q are one rotation; sums need neighbours on the same side.
  if (at(pushed_ - 1).tail<4>().dot(channels.tail<4>()) < 0.0) at(pushed_).tail<4>() *= -1.0;
  ++pushed_;
  const std::int64_t middle = pushed_ - 1 - 2 * kReach;  // counted from the first pose
  if (middle < 0 || middle % (kKnot_ns / kStep_ns) != 0) return;
  Channels mean = Channels::Zero();
  for (std::size_t k = 0; k < size; ++k)
    mean += kernel_[k] * at(pushed_ - 1 - 2 * kReach + static_cast<std::int64_t>(k));
  const Eigen::Vector4d q = mean.tail<4>().normalized();
  knots_.push_back({first_ns_ + middle * kStep_ns, {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), mean.head<3>()}});
}

Trajectory BandLimiter::finish() {
  if (!recent_.empty()) {
    const Channels last = recent_[static_cast<std::size_t>(pushed_ - 1) % recent_.size()];
    for (std::ptrdiff_t i = 0; i < kReach; ++i) push(last);
  }
  return Trajectory(knots_);
}

}  // namespace plumbline
