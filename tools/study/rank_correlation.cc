#include "tools/study/rank_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/random_stream.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

constexpr std::size_t kLeastPairs = 3;
constexpr int kRankResamples = 2000;
constexpr int kHalvings = 500;

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

void shuffle(std::vector<double>& values, RandomStream& draws) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[static_cast<std::size_t>(draws.integer(0, static_cast<int>(i) - 1))]);
  }
}

}  // namespace

std::optional<double> spearman(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() < kLeastPairs || x.size() != y.size()) return std::nullopt;
  const std::vector<double> rank_x = ranks_of(x);
  const std::vector<double> rank_y = ranks_of(y);
  const double mean = 0.5 * static_cast<double>(x.size() - 1);
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (rank_x[i] - mean) * (rank_x[i] - mean);
    yy += (rank_y[i] - mean) * (rank_y[i] - mean);
    xy += (rank_x[i] - mean) * (rank_y[i] - mean);
  }
  if (xx == 0.0 || yy == 0.0) return std::nullopt;
  return xy / std::sqrt(xx * yy);
}

std::optional<Interval> bootstrap_spearman(const std::vector<double>& x, const std::vector<double>& y,
                                           std::string_view stream) {
  const auto value = spearman(x, y);
  if (!value) return std::nullopt;
  RandomStream draws(1, stream);
  const int last = static_cast<int>(x.size()) - 1;
  std::vector<double> resampled;
  std::vector<double> some_x(x.size());
  std::vector<double> some_y(y.size());
  for (int i = 0; i < kRankResamples; ++i) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      const auto pick = static_cast<std::size_t>(draws.integer(0, last));
      some_x[k] = x[pick];
      some_y[k] = y[pick];
    }
    if (const auto r = spearman(some_x, some_y)) resampled.push_back(*r);
  }
  if (resampled.empty()) return Interval{*value, -1.0, 1.0};
  return Interval{*value, *quantile(resampled, 0.025), *quantile(resampled, 0.975)};
}

std::optional<double> split_half_ceiling(const std::vector<std::vector<double>>& samples, std::string_view stream) {
  const auto too_few = [](const std::vector<double>& of_one) { return of_one.size() < 2; };
  if (samples.size() < kLeastPairs || std::any_of(samples.begin(), samples.end(), too_few)) return std::nullopt;
  RandomStream draws(1, stream);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kHalvings; ++i) {
    std::vector<double> one;
    std::vector<double> other;
    for (std::vector<double> of_one : samples) {
      shuffle(of_one, draws);
      const auto middle = of_one.begin() + static_cast<std::ptrdiff_t>(of_one.size() / 2);
      one.push_back(*quantile({of_one.begin(), middle}, 0.5));
      other.push_back(*quantile({middle, of_one.end()}, 0.5));
    }
    if (const auto r = spearman(one, other)) {
      sum += *r;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  const double r = sum / count;
  return r <= 0.0 ? r : 2.0 * r / (1.0 + r);
}

}  // namespace plumbline
