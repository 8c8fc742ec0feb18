#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "tools/study/statistics.h"

namespace plumbline {

/// Differences after - before of paired runs, a list for each scenario.
using PairedStrata = std::vector<std::vector<double>>;

/// The mean over scenarios of their mean differences, and what can be said of it.
struct PairedMean {
  std::size_t pairs = 0;
  Interval mean;  ///< 95 %
  double standard_error = 0.0;
  double p_above = 1.0;             ///< of so large a mean if nothing had grown
  double p_below = 1.0;             ///< of so small a mean if nothing had shrunk
  std::vector<double> studentized;  ///< ascending: (resampled mean - mean) / its own standard error
};

/// Studentized bootstrap, stratified by scenario, the run being the unit that is drawn: what happens within a run is
/// not independent. 20,000 resamples, drawn from a stream of that name; so no p is below 5e-5.
/// Source: Efron and Tibshirani, An Introduction to the Bootstrap (1993), section 12.5.
/// @param strata  those with fewer than two differences tell nothing of their spread and are left out
PairedMean paired_bootstrap(const PairedStrata& strata, std::string_view stream);

/// The value of the studentized mean that is exceeded with probability p where nothing has changed; infinite if the
/// pairs are too few to tell.
double critical_value(const PairedMean& mean, double p);

/// P(X >= successes) of a fair coin thrown so often: the sign test.
double sign_test(std::size_t successes, std::size_t trials);

/// Which hypotheses to reject so that the probability of rejecting a true one is at most `level`, the level being
/// shared out by weight. Source: Holm, Scand. J. Statist. 6 (1979), section 4.
struct Hypothesis {
  double p = 1.0;
  double weight = 1.0;
};
std::vector<bool> holm(const std::vector<Hypothesis>& hypotheses, double level);

}  // namespace plumbline
