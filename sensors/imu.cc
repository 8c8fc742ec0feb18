#include "sensors/imu.h"

#include <cmath>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr double kGravity = 9.81;

Eigen::Vector3d gaussian_vector(RandomStream& stream) {
  const double x = stream.gaussian();
  const double y = stream.gaussian();
  const double z = stream.gaussian();
  return {x, y, z};
}

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace

void validate_or_throw(const ImuModel& model) {
  require(model.rate_hz >= 10.0 && model.rate_hz <= 2000.0, "imu: rate_hz must be in [10, 2000]");
  const ImuNoise& n = model.noise;
  for (const double v : {n.gyro_density, n.accel_density, n.gyro_random_walk, n.accel_random_walk, n.gyro_turn_on_sigma,
                         n.accel_turn_on_sigma}) {
    require(std::isfinite(v) && v >= 0.0, "imu: every noise figure must be finite and not negative");
  }
}

ImuSample exact_sample(const Trajectory& trajectory, std::int64_t start_ns, std::int64_t end_ns) {
  // Three-point Gauss-Legendre: exact for fifth-degree motion within the interval.
  const double half_width = std::sqrt(0.6);
  const double nodes[3] = {-half_width, 0.0, half_width};
  const double weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double middle = 0.5e-9 * static_cast<double>(start_ns + end_ns);
  const double half = 0.5e-9 * static_cast<double>(end_ns - start_ns);
  ImuSample sample;
  sample.stamp_ns = end_ns;
  for (int i = 0; i < 3; ++i) {
    const MotionState s = trajectory.at_seconds(middle + half * nodes[i]);
    const Eigen::Vector3d force_in_world = s.acceleration_in_world + kGravity * Eigen::Vector3d::UnitZ();
    sample.angular_rate += weights[i] * s.angular_rate_in_body;
    sample.specific_force += weights[i] * (s.world_from_body.rotation.conjugate() * force_in_world);
  }
  return sample;
}

Imu::Imu(ImuModel model, std::uint64_t seed) : model_(std::move(model)), stream_(seed, "imu") {
  validate_or_throw(model_);
  gyro_bias_ = model_.noise.gyro_turn_on_sigma * gaussian_vector(stream_);
  accel_bias_ = model_.noise.accel_turn_on_sigma * gaussian_vector(stream_);
}

std::int64_t Imu::period_ns() const { return std::llround(1e9 / model_.rate_hz); }

ImuSample Imu::sample(const Trajectory& trajectory, std::int64_t stamp_ns) {
  ImuSample sample = exact_sample(trajectory, stamp_ns - period_ns(), stamp_ns);
  if (!noise_enabled) return sample;
  const double dt = 1.0 / model_.rate_hz;
  const ImuNoise& n = model_.noise;
  gyro_bias_ += n.gyro_random_walk * std::sqrt(dt) * gaussian_vector(stream_);
  accel_bias_ += n.accel_random_walk * std::sqrt(dt) * gaussian_vector(stream_);
  sample.angular_rate += gyro_bias_ + n.gyro_density / std::sqrt(dt) * gaussian_vector(stream_);
  sample.specific_force += accel_bias_ + n.accel_density / std::sqrt(dt) * gaussian_vector(stream_);
  return sample;
}

}  // namespace plumbline
