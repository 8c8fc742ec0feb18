#include "tools/verify/allan.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/verify/chi_squared.h"

namespace plumbline {
namespace {

constexpr std::size_t kShortestLog = 9;  // in averages
// Square of the factor 0.664 from bias instability to the curve's floor.
const double kFloor = 2.0 * std::numbers::ln2 / std::numbers::pi;

/// Running sums, so that every average is one difference. The first value is taken off: it would cost digits.
std::vector<double> running_sums(const std::vector<double>& values) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + (values[i] - values.front());
  return sums;
}

/// Autocovariance of the wandering bias at lags in samples. The bias stands still within a step; over all phases of the
/// step that makes the autocovariance a line between the steps' own. A random walk has none; -|lag| / 2 times what it
/// grows by per sample takes its place, which gives the same differences of averages.
std::vector<double> bias_autocovariance(const NoiseFigures& figures, double rate_hz, std::size_t lags) {
  const auto step = static_cast<std::size_t>(samples_per_bias_step(rate_hz));
  const double step_s = static_cast<double>(step) / rate_hz;
  std::vector<double> at_steps(lags / step + 2, 0.0);
  for (const GaussMarkov& process : flicker_processes(figures.bias_instability)) {
    const double decay = std::exp(-step_s / process.time_constant_s);
    double value = process.sigma * process.sigma;
    for (double& sum : at_steps) {
      sum += value;
      value *= decay;
    }
  }
  const double walk = -0.5 * figures.random_walk * figures.random_walk / rate_hz;
  std::vector<double> covariance(lags);
  for (std::size_t lag = 0; lag < lags; ++lag) {
    const double share = static_cast<double>(lag % step) / static_cast<double>(step);
    covariance[lag] =
        (1.0 - share) * at_steps[lag / step] + share * at_steps[lag / step + 1] + walk * static_cast<double>(lag);
  }
  return covariance;
}

struct WeightedMean {
  double sum = 0.0;
  double weight = 0.0;
  void add(double value, double w) {
    sum += w * value;
    weight += w;
  }
};

}  // namespace

std::vector<AllanPoint> allan_variance(const std::vector<double>& values, double rate_hz) {
  const std::vector<double> sums = running_sums(values);
  std::vector<AllanPoint> curve;
  for (std::size_t m = 1; kShortestLog * m <= values.size(); m *= 2) {
    const std::size_t count = values.size() - 2 * m + 1;
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      const double difference = sums[j + 2 * m] - 2.0 * sums[j + m] + sums[j];
      sum += difference * difference;
    }
    const double width = static_cast<double>(m);
    curve.push_back({m, width / rate_hz, sum / (2.0 * width * width * static_cast<double>(count))});
  }
  return curve;
}

AllanModel::AllanModel(const NoiseFigures& figures, double resolution, double rate_hz, std::size_t samples)
    : sum_variance_(samples + 1, 0.0) {
  const std::vector<double> covariance = bias_autocovariance(figures, rate_hz, samples);
  const double white = figures.density * figures.density * rate_hz + resolution * resolution / 12.0;
  // The second difference of the sum's variance is twice the autocovariance.
  double growth = white + covariance.at(0);
  for (std::size_t t = 1; t <= samples; ++t) {
    sum_variance_[t] = sum_variance_[t - 1] + growth;
    if (t < samples) growth += 2.0 * covariance[t];
  }
}

AllanExpectation AllanModel::at(std::size_t samples) const {
  const std::size_t log = sum_variance_.size() - 1;
  const std::size_t count = log - 2 * samples + 1;
  // The differences' correlation is smooth on the scale of an average, and all but gone after four.
  const std::size_t stride = std::max<std::size_t>(1, samples / 512);
  const double variance = covariance_of_differences(samples, 0);
  double square_sum = static_cast<double>(count);
  for (std::size_t lag = stride; lag < 4 * samples && lag < count; lag += stride) {
    const double correlation = covariance_of_differences(samples, lag) / variance;
    square_sum += 2.0 * static_cast<double>(count - lag) * correlation * correlation;
  }
  const double width = static_cast<double>(samples);
  const double total = static_cast<double>(count);
  // Mean and variance of a sum of squares of correlated normal variables, matched to chi-squared's.
  return {0.5 * variance / (width * width), total * total / (square_sum * static_cast<double>(stride))};
}

/// Of the differences of neighbouring sums, whose weights are +1 at the ends, -2 in the middle.
double AllanModel::covariance_of_differences(std::size_t samples, std::size_t lag) const {
  const auto at_distance = [&](std::size_t a, std::size_t b) { return sum_variance_[a > b ? a - b : b - a]; };
  return -0.5 * (6.0 * sum_variance_[lag] - 4.0 * (sum_variance_[lag + samples] + at_distance(lag, samples)) +
                 sum_variance_[lag + 2 * samples] + at_distance(lag, 2 * samples));
}

AllanBand band_of(const AllanExpectation& expectation, double probability) {
  const double tail = 0.5 * (1.0 - probability);
  const double per_degree = expectation.variance / expectation.degrees_of_freedom;
  return {per_degree * chi_squared_quantile(tail, expectation.degrees_of_freedom),
          per_degree * chi_squared_quantile(1.0 - tail, expectation.degrees_of_freedom)};
}

double fitted_density(const std::vector<AllanPoint>& curve, double resolution, double rate_hz) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const AllanPoint& point : curve) {
    // A point's relative spread goes with the root of the averages' length.
    const double sigma = point.variance * std::sqrt(static_cast<double>(point.samples));
    const Eigen::Vector3d row = Eigen::Vector3d(1.0 / point.tau_s, 1.0, point.tau_s) / sigma;
    normal += row * row.transpose();
    right += row * point.variance / sigma;
  }
  // The unknowns differ by many orders of magnitude.
  const Eigen::Vector3d scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::Vector3d solution = scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(right)));
  return std::sqrt(std::max(0.0, solution[0] - resolution * resolution / (12.0 * rate_hz)));
}

double fitted_bias_instability(const std::vector<AllanPoint>& curve) {
  WeightedMean level;
  for (const AllanPoint& point : curve) {
    if (point.tau_s >= 8.0 && point.tau_s <= 1100.0) level.add(point.variance / kFloor, 1.0 / point.tau_s);
  }
  return std::sqrt(level.sum / level.weight);
}

double fitted_random_walk(const std::vector<AllanPoint>& curve) {
  WeightedMean square;
  for (const AllanPoint& point : curve) {
    // Short averages hold few of the bias's steps: the step shows.
    if (point.tau_s >= 1.0 && point.tau_s <= 100.0) square.add(3.0 * point.variance / point.tau_s, 1.0 / point.tau_s);
  }
  return std::sqrt(square.sum / square.weight);
}

}  // namespace plumbline
