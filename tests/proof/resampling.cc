#include "tests/proof/resampling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace plumbline {
namespace {

using Bank = std::map<std::string, std::vector<MeasuredRun>>;

Bank by_scenario(const std::vector<MeasuredRun>& runs) {
  Bank bank;
  for (const MeasuredRun& run : runs) bank[run.scenario].push_back(run);
  return bank;
}

/// Different places, in random order.
std::vector<std::size_t> drawn(std::size_t count, std::size_t from, RandomStream& draws) {
  if (count > from) {
    throw std::runtime_error("the bank holds " + std::to_string(from) + " seeds of a scenario, " +
                             std::to_string(count) + " are needed");
  }
  std::vector<std::size_t> places(from);
  for (std::size_t i = 0; i < from; ++i) places[i] = i;
  for (std::size_t i = 0; i < count; ++i) {
    const auto other = static_cast<std::size_t>(draws.integer(static_cast<int>(i), static_cast<int>(from) - 1));
    std::swap(places[i], places[other]);
  }
  places.resize(count);
  return places;
}

void add(std::vector<MeasuredRun>& runs, MeasuredRun run, std::uint64_t seed) {
  run.seed = seed;
  runs.push_back(std::move(run));
}

void count(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after, FailureCount& failures) {
  const Comparison comparison = compare_runs(before, after, {}, /*same_machine=*/true);
  ++failures.of;
  failures.failed += comparison.passes() ? 0 : 1;
  failures.by_main_figure += comparison.changes.front().worse ? 1 : 0;
}

/// P(X <= failed) of a binomial variable.
double at_most(std::size_t failed, std::size_t of, double rate) {
  if (rate <= 0.0) return 1.0;
  if (rate >= 1.0) return failed >= of ? 1.0 : 0.0;
  const auto n = static_cast<double>(of);
  double sum = 0.0;
  for (std::size_t k = 0; k <= failed; ++k) {
    const auto x = static_cast<double>(k);
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) + x * std::log(rate) +
                    (n - x) * std::log1p(-rate));
  }
  return std::min(1.0, sum);
}

template <typename IsAbove>
double bisected(IsAbove is_above) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (is_above(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

FailureCount against_itself(const std::vector<MeasuredRun>& bank, std::size_t seeds, std::size_t times) {
  const Bank scenarios = by_scenario(bank);
  RandomStream draws(1, "proof.against_itself");
  FailureCount failures;
  for (std::size_t i = 0; i < times; ++i) {
    std::vector<MeasuredRun> before;
    std::vector<MeasuredRun> after;
    for (const auto& [name, runs] : scenarios) {
      const std::vector<std::size_t> places = drawn(2 * seeds, runs.size(), draws);
      for (std::size_t s = 0; s < seeds; ++s) {
        add(before, runs[places[s]], s);
        add(after, runs[places[seeds + s]], s);
      }
    }
    count(before, after, failures);
  }
  return failures;
}

FailureCount against_each_other(const std::vector<MeasuredRun>& before_runs, const std::vector<MeasuredRun>& after_runs,
                                std::size_t seeds, std::size_t times) {
  const Bank before_bank = by_scenario(before_runs);
  const Bank after_bank = by_scenario(after_runs);
  RandomStream draws(1, "proof.against_each_other");
  FailureCount failures;
  for (std::size_t i = 0; i < times; ++i) {
    std::vector<MeasuredRun> before;
    std::vector<MeasuredRun> after;
    for (const auto& [name, runs] : before_bank) {
      for (const std::size_t place : drawn(seeds, runs.size(), draws)) {
        add(before, runs[place], place);
        add(after, after_bank.at(name).at(place), place);
      }
    }
    std::sort(before.begin(), before.end(), before_in_suite);
    std::sort(after.begin(), after.end(), before_in_suite);
    count(before, after, failures);
  }
  return failures;
}

double upper_bound_95(const FailureCount& count) {
  if (count.failed == count.of) return 1.0;
  return bisected([&](double rate) { return at_most(count.failed, count.of, rate) < 0.05; });
}

double lower_bound_95(const FailureCount& count) {
  if (count.failed == 0) return 0.0;
  return bisected([&](double rate) { return 1.0 - at_most(count.failed - 1, count.of, rate) > 0.05; });
}

}  // namespace plumbline
