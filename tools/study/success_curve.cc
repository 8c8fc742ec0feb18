#include "tools/study/success_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace plumbline {
namespace {

// The grid's cells, the boundary's place slowest: every place has its directions, every direction its slopes and
// lapses.
constexpr std::size_t kPlaces = 301;
constexpr double kFirstPlace = -0.25;
constexpr double kPlaceStep = 0.005;
constexpr std::array<double, 8> kSlopes = {0.004, 0.0075, 0.014, 0.026, 0.048, 0.09, 0.17, 0.31};
struct Lapse {
  double rate;
  double prior;
};
constexpr std::array<Lapse, 3> kLapses = {{{0.01, 0.6}, {0.05, 0.3}, {0.15, 0.1}}};
constexpr std::size_t kNuisance = kSlopes.size() * kLapses.size();
constexpr std::size_t kHypotheses = 2 * kPlaces;  // a place and a direction
constexpr std::size_t kCells = kHypotheses * kNuisance;

double place_of(std::size_t cell) { return kFirstPlace + kPlaceStep * static_cast<double>(cell / (2 * kNuisance)); }
bool falls_in(std::size_t cell) { return cell / kNuisance % 2 == 0; }

double entropy(double p) {
  if (p <= 0.0 || p >= 1.0) return 0.0;
  return -p * std::log(p) - (1.0 - p) * std::log(1.0 - p);
}

/// The value at which a share of the weight lies below; pairs are (value, weight) by ascending value.
double weighted_quantile(const std::vector<std::pair<double, double>>& sorted, double share) {
  double below = 0.0;
  for (const auto& [value, weight] : sorted) {
    below += weight;
    if (below >= share) return value;
  }
  return sorted.back().first;
}

/// Mutual information of one outcome and the hypotheses; p is the success's probability per cell.
double information_of(const std::vector<double>& weight, const double* p) {
  double mean = 0.0;
  double expected_entropy = 0.0;
  for (std::size_t hypothesis = 0; hypothesis < kHypotheses; ++hypothesis) {
    double mass = 0.0;
    double successes = 0.0;
    for (std::size_t cell = hypothesis * kNuisance; cell < (hypothesis + 1) * kNuisance; ++cell) {
      mass += weight[cell];
      successes += weight[cell] * p[cell];
    }
    mean += successes;
    if (mass > 0.0) expected_entropy += mass * entropy(successes / mass);
  }
  return entropy(mean) - expected_entropy;
}

}  // namespace

SuccessCurve::SuccessCurve(std::vector<double> positions) : positions_(std::move(positions)), log_weights_(kCells) {
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    log_weights_[cell] = std::log(kLapses[cell % kLapses.size()].prior);
  }
  success_.reserve(positions_.size() * kCells);
  for (const double position : positions_) {
    for (std::size_t cell = 0; cell < kCells; ++cell) success_.push_back(probability(cell, position));
  }
}

double SuccessCurve::probability(std::size_t cell, double position) const {
  const double lapse = kLapses[cell % kLapses.size()].rate;
  const double slope = kSlopes[cell / kLapses.size() % kSlopes.size()];
  const double beyond = (position - place_of(cell)) / slope;
  return lapse + (1.0 - 2.0 * lapse) / (1.0 + std::exp(falls_in(cell) ? beyond : -beyond));
}

void SuccessCurve::add(std::size_t position, bool success) {
  const double* p = &success_[position * kCells];
  for (std::size_t cell = 0; cell < kCells; ++cell) log_weights_[cell] += std::log(success ? p[cell] : 1.0 - p[cell]);
}

void SuccessCurve::suppose(std::size_t position) {
  const std::vector<double> weight = weights();
  const double* p = &success_[position * kCells];
  double expected = 0.0;
  for (std::size_t cell = 0; cell < kCells; ++cell) expected += weight[cell] * p[cell];
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    log_weights_[cell] += expected * std::log(p[cell]) + (1.0 - expected) * std::log(1.0 - p[cell]);
  }
}

std::vector<double> SuccessCurve::weights() const {
  const double largest = *std::max_element(log_weights_.begin(), log_weights_.end());
  std::vector<double> weight(kCells);
  double sum = 0.0;
  for (std::size_t cell = 0; cell < kCells; ++cell) sum += weight[cell] = std::exp(log_weights_[cell] - largest);
  for (double& w : weight) w /= sum;
  return weight;
}

std::vector<double> SuccessCurve::information() const {
  const std::vector<double> weight = weights();
  std::vector<double> information;
  for (std::size_t position = 0; position < positions_.size(); ++position) {
    information.push_back(information_of(weight, &success_[position * kCells]));
  }
  return information;
}

BoundaryEstimate SuccessCurve::boundary() const {
  const std::vector<double> weight = weights();
  std::vector<std::pair<double, double>> places;
  BoundaryEstimate estimate;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const double place = place_of(cell);
    if (places.empty() || places.back().first != place) places.emplace_back(place, 0.0);
    places.back().second += weight[cell];
    if (place >= 0.0 && place <= 1.0) estimate.probability_inside += weight[cell];
    if (falls_in(cell)) estimate.probability_falling += weight[cell];
  }
  estimate.median = weighted_quantile(places, 0.5);
  estimate.low = weighted_quantile(places, 0.025);
  estimate.high = weighted_quantile(places, 0.975);
  return estimate;
}

std::vector<CurvePoint> SuccessCurve::curve(const std::vector<double>& at) const {
  const std::vector<double> weight = weights();
  std::vector<CurvePoint> points;
  for (const double position : at) {
    std::vector<std::pair<double, double>> values;
    CurvePoint point{position, 0.0, 0.0, 0.0};
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      // What hardly weighs anything moves no quantile.
      if (weight[cell] < 1e-9) continue;
      values.emplace_back(probability(cell, position), weight[cell]);
      point.mean += weight[cell] * values.back().first;
    }
    std::sort(values.begin(), values.end());
    point.low = weighted_quantile(values, 0.025);
    point.high = weighted_quantile(values, 0.975);
    points.push_back(point);
  }
  return points;
}

}  // namespace plumbline
