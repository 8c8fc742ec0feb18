#include "tools/study/paired_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr int kResamples = 20'000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Moments {
  double mean = 0.0;
  double variance_of_mean = 0.0;
};

/// Of one stratum, its values given one by one.
template <typename Value>
Moments moments(std::size_t count, Value value) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = value();
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  return {mean, std::max(0.0, squares / n - mean * mean) / (n - 1.0)};
}

/// Each stratum shifted by its own mean: keeps sums of squares free of cancellation.
PairedStrata centred(const PairedStrata& strata) {
  PairedStrata result = strata;
  for (std::vector<double>& stratum : result) {
    const double mean = std::accumulate(stratum.begin(), stratum.end(), 0.0) / static_cast<double>(stratum.size());
    for (double& value : stratum) value -= mean;
  }
  return result;
}

double studentized(double difference, double variance) {
  if (variance > 0.0) return difference / std::sqrt(variance);
  return difference == 0.0 ? 0.0 : std::copysign(kInfinity, difference);
}

/// Share of resamples at least as extreme, counting what was seen as one of them.
double exceedance(std::ptrdiff_t count) { return (static_cast<double>(count) + 1.0) / (kResamples + 1.0); }

}  // namespace

PairedMean paired_bootstrap(const PairedStrata& given, std::string_view stream) {
  PairedMean result;
  PairedStrata strata;
  std::copy_if(given.begin(), given.end(), std::back_inserter(strata),
               [](const std::vector<double>& stratum) { return stratum.size() >= 2; });
  if (strata.empty()) return result;
  const auto share = 1.0 / static_cast<double>(strata.size());
  double variance = 0.0;
  for (const std::vector<double>& stratum : strata) {
    result.pairs += stratum.size();
    auto next = stratum.begin();
    const Moments own = moments(stratum.size(), [&] { return *next++; });
    result.mean.value += share * own.mean;
  }
  strata = centred(strata);
  for (const std::vector<double>& stratum : strata) {
    auto next = stratum.begin();
    variance += share * share * moments(stratum.size(), [&] { return *next++; }).variance_of_mean;
  }
  result.standard_error = std::sqrt(variance);

  RandomStream draws(1, stream);
  result.studentized.reserve(kResamples);
  for (int i = 0; i < kResamples; ++i) {
    Moments all;
    for (const std::vector<double>& stratum : strata) {
      const int last = static_cast<int>(stratum.size()) - 1;
      const Moments own =
          moments(stratum.size(), [&] { return stratum[static_cast<std::size_t>(draws.integer(0, last))]; });
      all.mean += share * own.mean;
      all.variance_of_mean += share * share * own.variance_of_mean;
    }
    result.studentized.push_back(studentized(all.mean, all.variance_of_mean));
  }
  std::sort(result.studentized.begin(), result.studentized.end());

  const auto& sorted = result.studentized;
  const double seen = studentized(result.mean.value, variance);
  result.p_above =
      exceedance(seen > 0.0 ? sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), seen) : kResamples);
  result.p_below =
      exceedance(seen < 0.0 ? std::upper_bound(sorted.begin(), sorted.end(), seen) - sorted.begin() : kResamples);
  const double upper = critical_value(result, 0.025);
  const double lower = sorted[static_cast<std::size_t>(0.025 * kResamples)];
  const auto reach = [&](double times) { return variance > 0.0 ? times * result.standard_error : 0.0; };
  result.mean.low = result.mean.value - reach(upper);
  result.mean.high = result.mean.value - reach(lower);
  return result;
}

double critical_value(const PairedMean& mean, double p) {
  const auto& sorted = mean.studentized;
  if (sorted.empty()) return kInfinity;
  const auto beyond = static_cast<std::size_t>(p * (kResamples + 1.0));
  return beyond < 1 ? kInfinity : sorted[sorted.size() - std::min(beyond, sorted.size())];
}

double sign_test(std::size_t successes, std::size_t trials) {
  double p = 0.0;
  const auto n = static_cast<double>(trials);
  for (std::size_t k = successes; k <= trials; ++k) {
    const auto x = static_cast<double>(k);
    p += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) - n * std::log(2.0));
  }
  return std::min(1.0, p);
}

std::vector<bool> holm(const std::vector<Hypothesis>& hypotheses, double level) {
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), 0);
  const auto cost = [&](std::size_t i) { return hypotheses[i].p / hypotheses[i].weight; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  double weight_left = 0.0;
  for (const Hypothesis& hypothesis : hypotheses) weight_left += hypothesis.weight;
  std::vector<bool> rejected(hypotheses.size(), false);
  for (const std::size_t i : order) {
    if (cost(i) * weight_left > level) break;
    rejected[i] = true;
    weight_left -= hypotheses[i].weight;
  }
  return rejected;
}

}  // namespace plumbline
