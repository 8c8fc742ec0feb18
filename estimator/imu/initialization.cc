#include "estimator/imu/initialization.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "estimator/geometry/so3.h"
#include "estimator/imu/squared.h"

namespace plumbline {
namespace {
constexpr double kRestWindow_s = 1.0;  // averages a consumer gyro's bias to 0.02 deg/s
constexpr double kDecisionWindow_s = 0.1;
// What the deviations from the mean integrate to within a second: a hand held still 0.02 rad and 0.03 m/s, cars and
// carts at constant speed 0.07 m/s and more, a walker 0.3 m/s.
constexpr double kRestStray = 0.05;       // [m/s]
constexpr double kManoeuvreStray = 0.25;  // [m/s]
constexpr double kManoeuvreAngle = 0.05;  // [rad]
constexpr double kMaxRestRate = 0.1;      // [rad/s], above any turn-on bias at rest
constexpr double kMaxGravityError = 0.5;  // [m/s^2], of the mean force's length
constexpr double kStillWindow_s = 0.2;    // wheels and rotors shake a body more often than that
constexpr double kRestVelocity = 0.01;    // [m/s]
constexpr double kSteadyTilt = 0.03;      // [rad], a vehicle that gently gains or loses speed
constexpr double kManoeuvreTilt = 0.1;    // [rad], while walking the mean force is off the vertical by about this
constexpr double kTravelVelocity = 5.0;   // [m/s]
constexpr double kImplausibleBias = 5.0;  // turn-on sigmas; more than that about the vertical is a turn
constexpr double kSurprise = 3.0;         // sigmas
constexpr double kStillStray = 5.0;       // times the noise's own walk: a hand strays 12 times as far, an idle engine 3
constexpr double kRestSigma = 1e-4;       // [rad, m] a sample
constexpr double kLeastForce = 1e-3;      // [m/s^2]; below, it says nothing of up
constexpr double kBiasStep = 1e-4;        // [rad/s] of differences
// What a body strays says how much of its mean rate may be motion. Between two random moments of a swing or a tremble
// it turns by half its range, root mean square; of a swing that takes four times as long as it was watched, the mean
// rate hides most.
constexpr double kTremble = 0.5;
constexpr double kSlowSwing = 1.5;

/// Range of the walk that the deviations from the mean integrate to, the longest axis.
template <typename Reading>
double range_of_walk(std::span<const ImuSample> samples, const Eigen::Vector3d& mean, double period, Reading reading) {
  Eigen::Vector3d walk = Eigen::Vector3d::Zero(), low = walk, high = walk;
  for (const ImuSample& sample : samples) {
    walk += period * (reading(sample) - mean);
    low = low.cwiseMin(walk);
    high = high.cwiseMax(walk);
  }
  return (high - low).maxCoeff();
}

Eigen::Vector3d rate_of(const ImuSample& sample) { return sample.angular_rate; }
Eigen::Vector3d force_of(const ImuSample& sample) { return sample.specific_force; }

/// Whether readings do not stray from their own mean farther than their noise walks.
template <typename Reading>
bool still(std::span<const ImuSample> samples, double density, double period, Reading reading) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) mean += reading(sample) / static_cast<double>(samples.size());
  const double seconds = period * static_cast<double>(samples.size());
  return range_of_walk(samples, mean, period, reading) < kStillStray * density * std::sqrt(seconds);
}

/// Level, with no heading, where `up` is in B.
Eigen::Quaterniond level(const Eigen::Vector3d& up) {
  return rotation_from_rpy({std::atan2(up.y(), up.z()), std::atan2(-up.x(), std::hypot(up.y(), up.z())), 0.0});
}

}  // namespace

Initializer::Initializer(const Calibration& calibration) : noise_(calibration.imu), rate_hz_(calibration.imu_rate_hz) {}

std::optional<InitialState> Initializer::add(const ImuSample& sample) {
  samples_.push_back(sample);
  const auto count = static_cast<double>(samples_.size());
  mean_rate_ += (sample.angular_rate - mean_rate_) / count;
  mean_force_ += (sample.specific_force - mean_force_) / count;

  const Excursion strayed = excursion();
  settle(strayed);
  const double elapsed = count / rate_hz_;
  if (elapsed < kDecisionWindow_s) return std::nullopt;
  const bool manoeuvres = manoeuvring(strayed);
  if (!manoeuvres && elapsed < kRestWindow_s) return std::nullopt;

  if (!manoeuvres) return calm_start(strayed);
  InitialState start;
  start.state.stamp_ns = sample.stamp_ns;
  start.tilt_sigma = kManoeuvreTilt;
  start.gyro_bias_covariance.diagonal().setConstant(squared(noise_.gyro_turn_on_sigma));
  start.velocity_sigma = kTravelVelocity;
  set_attitude(start);
  return start;
}

/// From what has been seen so far, of a body at rest or steady.
InitialState Initializer::calm_start(const Excursion& strayed) const {
  InitialState start;
  start.state.stamp_ns = samples_.back().stamp_ns;
  const double elapsed = static_cast<double>(samples_.size()) / rate_hz_;
  const bool at_rest = strayed.velocity < kRestStray || has_been_still();
  find_gyro_bias(strayed, at_rest, start);
  // Only the length of the mean force is known to be gravity's; its direction is shared with the attitude.
  if (mean_force_.norm() > kLeastForce)
    start.state.accel_bias = mean_force_ * (1.0 - kStandardGravity / mean_force_.norm());
  const double force_sigma =
      std::hypot(noise_.accel_density / std::sqrt(elapsed), hidden_share(strayed) * strayed.velocity / elapsed);
  start.tilt_sigma = std::hypot(force_sigma / kStandardGravity, at_rest ? 0.0 : kSteadyTilt);
  start.velocity_sigma = at_rest ? std::hypot(kRestVelocity, strayed.velocity) : kTravelVelocity;
  set_attitude(start);
  return start;
}

void Initializer::set_attitude(InitialState& start) const {
  start.state.world_from_body = attitude_now(start.state.gyro_bias);
  for (int i = 0; i < 3; ++i) {
    const Pose varied = attitude_now(start.state.gyro_bias + kBiasStep * Eigen::Vector3d::Unit(i));
    start.d_attitude_d_gyro_bias.col(i) =
        log_so3(start.state.world_from_body.rotation.conjugate() * varied.rotation) / kBiasStep;
  }
}

bool Initializer::turns_no_more_than_noise(const Excursion& strayed) const {
  const double elapsed = static_cast<double>(samples_.size()) / rate_hz_;
  return strayed.angle < kStillStray * noise_.gyro_density * std::sqrt(elapsed);
}

double Initializer::hidden_share(const Excursion& strayed) const {
  return turns_no_more_than_noise(strayed) ? kTremble : kSlowSwing;
}

/// The mean rate as a measurement of the bias, weighed against what the data sheet says of it. Data sheets are beaten
/// by single units, so a mean that they cannot explain widens the expectation, if nothing moves; in a hand it is a
/// turn.
void Initializer::find_gyro_bias(const Excursion& strayed, bool at_rest, InitialState& start) const {
  const double elapsed = static_cast<double>(samples_.size()) / rate_hz_;
  const double noise_sigma = noise_.gyro_density / std::sqrt(elapsed);
  const double rate_sigma = std::hypot(noise_sigma, hidden_share(strayed) * strayed.angle / elapsed);
  const bool still = turns_no_more_than_noise(strayed);
  const Eigen::Vector3d up = mean_force_.norm() > kLeastForce ? mean_force_.normalized() : Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d body_from_world = level(up).conjugate().toRotationMatrix();
  const Eigen::Vector3d mean = body_from_world.transpose() * mean_rate_;
  Eigen::Vector3d bias, variance;
  for (int i = 0; i < 3; ++i) {
    const bool surprises = std::abs(mean[i]) > kSurprise * std::hypot(noise_.gyro_turn_on_sigma, rate_sigma);
    const double expected = surprises ? std::abs(mean[i]) : noise_.gyro_turn_on_sigma;
    const bool turns = (surprises && !still) ||
                       (!at_rest && i == 2 && std::abs(mean[i]) > kImplausibleBias * noise_.gyro_turn_on_sigma);
    const double weight = turns ? 0.0 : squared(expected) / (squared(expected) + squared(rate_sigma));
    bias[i] = weight * mean[i];
    variance[i] = turns ? squared(noise_.gyro_turn_on_sigma) : weight * squared(rate_sigma);
  }
  start.state.gyro_bias = body_from_world * bias;
  start.gyro_bias_covariance = body_from_world * variance.asDiagonal() * body_from_world.transpose();
}

Initializer::Excursion Initializer::excursion() const {
  const double period = 1.0 / rate_hz_;
  return {range_of_walk(samples_, mean_rate_, period, rate_of), range_of_walk(samples_, mean_force_, period, force_of)};
}

bool Initializer::has_been_still() const {
  const double period = 1.0 / rate_hz_;
  const auto length = static_cast<std::size_t>(std::lround(kStillWindow_s * rate_hz_));
  const std::span<const ImuSample> all(samples_);
  for (std::size_t first = 0; length > 1 && first + length <= all.size(); first += length) {
    const auto stretch = all.subspan(first, length);
    if (still(stretch, noise_.gyro_density, period, rate_of) &&
        still(stretch, noise_.accel_density, period, force_of)) {
      return true;
    }
  }
  return false;
}

bool Initializer::manoeuvring(const Excursion& excursion) const {
  const double gravity_error = std::abs(mean_force_.norm() - kStandardGravity);
  return excursion.angle > kManoeuvreAngle || excursion.velocity > kManoeuvreStray ||
         mean_rate_.norm() > kMaxRestRate ||
         gravity_error > std::max(kMaxGravityError, 3.0 * noise_.accel_turn_on_sigma);
}

void Initializer::settle(const Excursion& strayed) {
  const NavigationState settled = calm_start(strayed).state;
  const Eigen::Quaterniond now_from_before = exp_so3((settled.gyro_bias - samples_.back().angular_rate) / rate_hz_);
  if (samples_.size() > 1) {
    const Eigen::Quaterniond foreseen = attitude_.rotation * now_from_before.conjugate();
    revision_ = std::exp(-1.0 / (rate_hz_ * kRevisionMemory_s)) * (now_from_before * revision_);
    revision_ += log_so3(foreseen.conjugate() * settled.world_from_body.rotation);
  }
  attitude_ = settled.world_from_body;
}

Matrix6d Initializer::increment_covariance() const {
  Matrix6d covariance = Matrix6d::Identity() * (kRestSigma * kRestSigma);
  covariance.topLeftCorner<3, 3>() += revision_ * revision_.transpose() / (rate_hz_ * kRevisionMemory_s);
  return covariance;
}

/// A hand turns by degrees within a second: forces are averaged in the newest B, and the heading has changed since the
/// first sample.
Pose Initializer::attitude_now(const Eigen::Vector3d& gyro_bias) const {
  Eigen::Quaterniond now_from_then = Eigen::Quaterniond::Identity();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    force += now_from_then * sample->specific_force;
    now_from_then = now_from_then * exp_so3((gyro_bias - sample->angular_rate) / rate_hz_);
  }
  if (force.norm() < kLeastForce * static_cast<double>(samples_.size())) return {};
  const Eigen::Quaterniond level_from_now = level(force.normalized());
  const Eigen::Vector3d ahead_at_first = level_from_now * now_from_then * Eigen::Vector3d::UnitX();
  const Eigen::AngleAxisd undone(-std::atan2(ahead_at_first.y(), ahead_at_first.x()), Eigen::Vector3d::UnitZ());
  return {undone * level_from_now, Eigen::Vector3d::Zero()};
}

}  // namespace plumbline
