#include "tools/verify/imu_check.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr double kLog_s = 2.0 * 3600.0;
constexpr double kFlickerLog_s = 8.0 * 3600.0;
constexpr double kConfidence = 0.95;

using AxisLogs = std::array<std::vector<double>, 3>;

struct RestLog {
  AxisLogs gyro;
  AxisLogs accel;
};

void append(const Eigen::Vector3d& value, AxisLogs& logs) {
  for (std::size_t axis = 0; axis < 3; ++axis) logs[axis].push_back(value[static_cast<Eigen::Index>(axis)]);
}

RestLog rest_log(const ImuModel& model, std::uint64_t seed) {
  Imu imu(model, seed);
  ImuSample truth;
  truth.specific_force = {0.0, 0.0, 9.81};
  const auto samples = static_cast<std::int64_t>(kLog_s * model.rate_hz);
  RestLog log;
  for (auto* logs : {&log.gyro, &log.accel}) {
    for (auto& axis : *logs) axis.reserve(static_cast<std::size_t>(samples));
  }
  for (std::int64_t k = 0; k < samples; ++k) {
    const ImuSample sample = imu.measured(truth);
    append(sample.angular_rate, log.gyro);
    append(sample.specific_force, log.accel);
  }
  return log;
}

/// Curves of one component of the wandering bias, logged at its own steps.
std::array<std::vector<AllanPoint>, 3> bias_curves(const NoiseFigures& component, double rate_hz, double duration_s,
                                                   std::uint64_t seed, const std::string& name) {
  const double step_s = samples_per_bias_step(rate_hz) / rate_hz;
  WanderingBias bias(component, step_s, seed, name);
  AxisLogs logs;
  const auto steps = static_cast<std::int64_t>(duration_s / step_s);
  for (std::int64_t k = 0; k < steps; ++k) append(bias.next(), logs);
  std::array<std::vector<AllanPoint>, 3> curves;
  for (std::size_t axis = 0; axis < 3; ++axis) curves[axis] = allan_variance(logs[axis], 1.0 / step_s);
  return curves;
}

TriadCheck check_triad(const AxisLogs& logs, const NoiseFigures& figures, const TriadErrors& errors, double rate_hz,
                       std::size_t units, std::uint64_t seed, const std::string& name) {
  TriadCheck check;
  check.figures = figures;
  const AllanModel model(figures, errors.resolution, rate_hz, logs[0].size());
  const auto flicker = bias_curves({0.0, figures.bias_instability, 0.0}, rate_hz, kFlickerLog_s, seed, name);
  const auto walk = bias_curves({0.0, 0.0, figures.random_walk}, rate_hz, kLog_s, seed, name);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    check.curves[axis] = allan_variance(logs[axis], rate_hz);
    check.density[axis] = fitted_density(check.curves[axis], errors.resolution, rate_hz);
    check.bias_instability[axis] = fitted_bias_instability(flicker[axis]);
    check.random_walk[axis] = fitted_random_walk(walk[axis]);
  }
  // Bonferroni's inequality, over the points of six curves of every unit.
  const double points = 6.0 * static_cast<double>(units * check.curves[0].size());
  const double joint_confidence = 1.0 - (1.0 - kConfidence) / points;
  for (const AllanPoint& point : check.curves[0]) {
    check.expected.push_back(model.at(point.samples));
    check.band.push_back(band_of(check.expected.back(), kConfidence));
    check.joint_band.push_back(band_of(check.expected.back(), joint_confidence));
  }
  return check;
}

}  // namespace

ImuCheck check_imu(const ImuModel& model, std::size_t units, std::uint64_t catalogue_seed) {
  // Units differ: one seed for all would draw the same noise for each.
  const std::uint64_t seed = derive_seed(catalogue_seed, model.name);
  const RestLog log = rest_log(model, seed);
  ImuCheck check;
  check.model = model;
  check.gyro = check_triad(log.gyro, gyro_figures(model), model.gyro, model.rate_hz, units, seed, "imu.gyro");
  check.accel = check_triad(log.accel, accel_figures(model), model.accel, model.rate_hz, units, seed, "imu.accel");
  return check;
}

double worst_error(const std::array<double, 3>& given_back, double figure) {
  double worst = 0.0;
  for (const double value : given_back) worst = std::max(worst, std::abs(value / figure - 1.0));
  return worst;
}

double share_within(const TriadCheck& check, const std::vector<AllanBand>& band) {
  int within = 0;
  int all = 0;
  for (const auto& curve : check.curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      ++all;
      if (curve[i].variance >= band[i].low && curve[i].variance <= band[i].high) ++within;
    }
  }
  return static_cast<double>(within) / all;
}

}  // namespace plumbline
