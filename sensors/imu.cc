#include "sensors/imu.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/constants.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

ImuModel validated(ImuModel model) {
  validate_or_throw(model);
  return model;
}

/// Gain errors on the diagonal, misalignment beside it.
Eigen::Matrix3d drawn_gain(const TriadErrors& errors, const ImuEffects& effects, std::uint64_t seed,
                           const std::string& name) {
  RandomStream scale(seed, name + ".scale");
  RandomStream misalignment(seed, name + ".misalignment");
  const Eigen::Vector3d gain_errors = errors.scale_sigma * gaussian_vector(scale);
  Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d lean = errors.misalignment_sigma_rad * gaussian_vector(misalignment);
    for (int column = 0; column < 3; ++column) {
      if (row == column && effects.scale) gain(row, column) += gain_errors[row];
      if (row != column && effects.misalignment) gain(row, column) = lean[column];
    }
  }
  return gain;
}

Eigen::Matrix3d drawn_g_sensitivity(const ImuModel& model, std::uint64_t seed) {
  RandomStream stream(seed, "imu.gyro.g_sensitivity");
  Eigen::Matrix3d sensitivity = Eigen::Matrix3d::Zero();
  if (!model.effects.g_sensitivity) return sensitivity;
  for (int column = 0; column < 3; ++column) {
    sensitivity.col(column) = model.g_sensitivity_sigma * gaussian_vector(stream);
  }
  return sensitivity;
}

Eigen::Vector3d drawn_turn_on(bool enabled, const std::optional<Eigen::Vector3d>& given, double sigma,
                              std::uint64_t seed, const std::string& name) {
  if (!enabled) return Eigen::Vector3d::Zero();
  if (given) return *given;
  RandomStream stream(seed, name + ".turn_on");
  return sigma * gaussian_vector(stream);
}

Eigen::Vector3d output_of(Eigen::Vector3d reading, const TriadErrors& errors, const ImuEffects& effects) {
  if (effects.saturation && errors.range > 0.0) reading = reading.cwiseMax(-errors.range).cwiseMin(errors.range);
  if (effects.quantisation && errors.resolution > 0.0) {
    for (double& value : reading) value = errors.resolution * std::round(value / errors.resolution);
  }
  return reading;
}

NoiseFigures acting(const ImuEffects& effects, const NoiseFigures& figures) {
  return {effects.white_noise ? figures.density : 0.0, effects.bias_instability ? figures.bias_instability : 0.0,
          effects.random_walk ? figures.random_walk : 0.0};
}

/// Adds the mean over a time without a knot, by three-point Gauss-Legendre: exact for fifth-degree motion.
void add_smooth_piece(const Trajectory& trajectory, double from_s, double to_s, const Eigen::Vector3d& position_in_body,
                      double share, ImuSample& sample) {
  const double node = std::sqrt(0.6);
  const double nodes[3] = {-node, 0.0, node};
  const double weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double middle_s = 0.5 * (from_s + to_s);
  const double half_s = 0.5 * (to_s - from_s);
  for (int i = 0; i < 3; ++i) {
    const MotionState s = trajectory.at_seconds(middle_s + half_s * nodes[i]);
    const Eigen::Vector3d force_in_world = s.acceleration_in_world + kGravity * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d& rate = s.angular_rate_in_body;
    const Eigen::Vector3d euler = s.angular_acceleration_in_body.cross(position_in_body);
    const Eigen::Vector3d centripetal = rate.cross(rate.cross(position_in_body));
    sample.angular_rate += share * weights[i] * rate;
    sample.specific_force +=
        share * weights[i] * (s.world_from_body.rotation.conjugate() * force_in_world + euler + centripetal);
  }
}

}  // namespace

NoiseFigures gyro_figures(const ImuModel& model) {
  const ImuNoise& n = model.noise;
  return acting(model.effects, {n.gyro_density, n.gyro_bias_instability, n.gyro_random_walk});
}

NoiseFigures accel_figures(const ImuModel& model) {
  const ImuNoise& n = model.noise;
  return acting(model.effects, {n.accel_density, n.accel_bias_instability, n.accel_random_walk});
}

ImuSample exact_sample(const Trajectory& trajectory, std::int64_t start_ns, std::int64_t end_ns,
                       const Eigen::Vector3d& position_in_body) {
  const double start_s = static_cast<double>(start_ns) * 1e-9;
  const double end_s = static_cast<double>(end_ns) * 1e-9;
  ImuSample sample;
  sample.stamp_ns = end_ns;
  for (double from_s = start_s; from_s < end_s;) {
    const double to_s = std::min(trajectory.knot_after_s(from_s), end_s);
    add_smooth_piece(trajectory, from_s, to_s, position_in_body, (to_s - from_s) / (end_s - start_s), sample);
    from_s = to_s;
  }
  return sample;
}

Imu::Imu(ImuModel model, std::uint64_t seed)
    : model_(validated(std::move(model))),
      vibration_(model_.vibration, seed),
      gyro_gain_(drawn_gain(model_.gyro, model_.effects, seed, "imu.gyro")),
      accel_gain_(drawn_gain(model_.accel, model_.effects, seed, "imu.accel")),
      rate_from_force_(drawn_g_sensitivity(model_, seed)),
      gyro_turn_on_(drawn_turn_on(model_.effects.turn_on_bias, model_.gyro_turn_on_bias,
                                  model_.noise.gyro_turn_on_sigma, seed, "imu.gyro")),
      accel_turn_on_(drawn_turn_on(model_.effects.turn_on_bias, model_.accel_turn_on_bias,
                                   model_.noise.accel_turn_on_sigma, seed, "imu.accel")),
      gyro_noise_(gyro_figures(model_), model_.rate_hz, seed, "imu.gyro"),
      accel_noise_(accel_figures(model_), model_.rate_hz, seed, "imu.accel") {}

std::int64_t Imu::period_ns() const { return std::llround(1e9 / model_.rate_hz); }

ImuSample Imu::sample(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const std::int64_t start_ns = stamp_ns - period_ns();
  ImuSample truth = exact_sample(trajectory, start_ns, stamp_ns, model_.position_in_body);
  if (!noise_enabled) return truth;
  if (model_.effects.vibration && !vibration_.is_still()) {
    const double speed_mps = trajectory.at(stamp_ns).velocity_in_world.norm();
    truth.specific_force += vibration_.mean(start_ns, stamp_ns, speed_mps);
  }
  return measured(truth);
}

ImuSample Imu::measured(const ImuSample& truth) {
  ImuSample sample;
  sample.stamp_ns = truth.stamp_ns;
  const Eigen::Vector3d rate = gyro_gain_ * truth.angular_rate + rate_from_force_ * truth.specific_force;
  const Eigen::Vector3d force = accel_gain_ * truth.specific_force;
  sample.angular_rate = output_of(rate + gyro_turn_on_ + gyro_noise_.next(), model_.gyro, model_.effects);
  sample.specific_force = output_of(force + accel_turn_on_ + accel_noise_.next(), model_.accel, model_.effects);
  return sample;
}

}  // namespace plumbline
