#include "tools/study/statistics.h"

#include <algorithm>
#include <cmath>

#include "sim/random_stream.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

constexpr double kTwoSided95 = 1.959963984540054;
constexpr int kResamples = 2000;

}  // namespace

Interval wilson_interval(std::size_t successes, std::size_t trials) {
  const auto n = static_cast<double>(trials);
  const double rate = static_cast<double>(successes) / n;
  const double z2_over_n = kTwoSided95 * kTwoSided95 / n;
  const double centre = (rate + 0.5 * z2_over_n) / (1.0 + z2_over_n);
  const double half = kTwoSided95 * std::sqrt(rate * (1.0 - rate) / n + 0.25 * z2_over_n / n) / (1.0 + z2_over_n);
  return {rate, std::min(rate, std::max(0.0, centre - half)), std::max(rate, std::min(1.0, centre + half))};
}

std::optional<Interval> bootstrap_median(const std::vector<double>& values, std::string_view stream) {
  const auto median = quantile(values, 0.5);
  if (!median) return std::nullopt;
  RandomStream draws(1, stream);
  const int last = static_cast<int>(values.size()) - 1;
  std::vector<double> medians;
  std::vector<double> resample(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : resample) value = values[static_cast<std::size_t>(draws.integer(0, last))];
    medians.push_back(*quantile(resample, 0.5));
  }
  return Interval{*median, *quantile(medians, 0.025), *quantile(medians, 0.975)};
}

}  // namespace plumbline
